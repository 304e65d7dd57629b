#include "render.hpp"

#include <fmt/format.h>

#include <memory>

#include "mcdbn/base/errors.hpp"
#include "setting_flags.hpp"

namespace mcdbn::cli {
namespace {

/// @throws ConfigError if the option was given, and what is written would ignore it
void refuse_ignored(const std::filesystem::path& output, const CLI::Option& option,
                    const char* ignoring, const char* heeding) {
  if (option.count() > 0 && output.extension() == ignoring)
    throw ConfigError(fmt::format("{} is for --output FILE{}", option.get_name(), heeding));
}

}  // namespace

void add_render_command(CLI::App& app, CommandContext& context) {
  auto options = std::make_shared<RenderCommandOptions>();
  RenderOptions& render = options->render;
  options->camera.placement = render.placement;
  CLI::App* command = app.add_subcommand("render", "Draws BVH clips as a video or a contact sheet");
  command
      ->add_option("clips", options->clips,
                   "BVH files, shown side by side (in a sheet, row by row)")
      ->required()
      ->type_name("FILE...");
  mark_output(command->add_option("-o,--output", options->output,
                                  "What to write: .mp4 is a video, .png a contact sheet"),
              context)
      ->required()
      ->type_name("FILE");
  CLI::Option* const over =
      command
          ->add_option(
              "--over", render.over,
              "Film to draw the clips over, as --camera sees them, from its frame --over-from on")
          ->type_name("FILE");
  command->add_option("--over-from", render.over_from, "Frame of the film where the clips begin")
      ->check(in_range(within(0, 1e7)))
      ->needs(over)
      ->capture_default_str();
  command->add_flag("--overlay", render.overlay, "All clips in one picture")->excludes(over);
  CLI::Option* const orbit =
      command->add_flag("--orbit", render.orbit, "The camera circles the figure");
  command->add_option("--orbit-speed", render.orbit_deg_per_s, "Speed of --orbit, degrees a second")
      ->check(in_range(within(-3600, 3600)))
      ->needs(orbit)
      ->capture_default_str();
  CLI::Option* const still = command->add_flag(
      "!--still-camera", render.follow_root,
      "The camera stands still and sees the whole path; else it follows the figure");
  const CLI::Option* const video_fps =
      command
          ->add_option("--video-fps", render.fps,
                       "Frames a second of a video (default: the first clip's, at most 60)")
          ->check(in_range(within(1, 240)))
          ->excludes(over);
  const CLI::Option* const columns =
      command->add_option("--columns", render.sheet_columns, "Frames in a row of a contact sheet")
          ->check(in_range(within(1, 64)))
          ->capture_default_str();
  options->preparation.fps = 0;  // a film shows every frame
  add_clip_options(*command, options->preparation);
  add_camera_options(*command, options->camera);
  CLI::Option* const camera = command->get_option("--camera");
  for (CLI::Option* moving : {orbit, still}) moving->excludes(camera);
  command->get_option("--image-size")
      ->description(
          "Width and height in pixels of each clip's picture (default: 640 720 in a video, 240 320 "
          "in a sheet)");
  add_quiet_option(*command, context);
  command->footer("Example:\n  mcdbn-cl render truth.bvh regenerated.bvh --orbit -o compare.mp4");
  command->callback([&context, options, video_fps, columns] {
    context.run = [&context, options, video_fps, columns] {
      refuse_ignored(options->output, *video_fps, ".png", ".mp4");
      refuse_ignored(options->output, *columns, ".mp4", ".png");
      run_render(*options, context);
    };
  });
}

}  // namespace mcdbn::cli
