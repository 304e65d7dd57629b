#include <spdlog/spdlog.h>

#include <filesystem>
#include <memory>

#include "camera/track_noise.hpp"
#include "camera_options.hpp"
#include "clip_options.hpp"
#include "commands.hpp"
#include "mcdbn/camera/track.hpp"
#include "mcdbn/formats/camera_file.hpp"
#include "mcdbn/formats/track_csv.hpp"
#include "setting_flags.hpp"

namespace mcdbn::cli {
namespace {

struct ProjectOptions {
  std::filesystem::path clip, output, camera_output;
  CameraOptions camera;
  ClipOptions preparation;
  double noise_px = 0.0;
};

void run_project(const CommandContext& context, const ProjectOptions& options) {
  const Motion motion = load_clip_with_notices(options.clip, options.preparation);
  const Camera camera = options.camera.camera_for(motion);
  Track2d track = project_motion(motion, camera);
  add_pixel_noise(track, options.noise_px, context.seed);
  write_track_csv(options.output, track);
  if (!options.camera_output.empty()) write_camera(options.camera_output, camera);
  spdlog::info("{}: {} frames of {} joints at {:.4g} fps", options.output.string(), track.frames(),
               track.joint_count(), track.fps);
}

}  // namespace

void add_project_command(CLI::App& app, CommandContext& context) {
  auto options = std::make_shared<ProjectOptions>();
  CLI::App* command =
      app.add_subcommand("project", "Projects a BVH clip through a camera to a 2D joint track");
  command->add_option("clip", options->clip, "BVH file")->required()->type_name("FILE");
  command->add_option("-o,--output", options->output, "Track to write, CSV")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("--write-camera", options->camera_output,
                   "Also write the camera that was used, as OpenCV YAML")
      ->type_name("FILE");
  add_setting_flag(*command, "--noise-px",
                   {"noise-px", TrackDamage::kNoise_px, "px",
                    "Standard deviation of Gaussian noise on every joint's x and y"},
                   options->noise_px);
  add_clip_options(*command, options->preparation);
  add_camera_options(*command, options->camera);
  add_seed_option(*command, context);
  add_quiet_option(*command, context);
  command->footer(
      "Example:\n  mcdbn-cl project walk.bvh --camera-azimuth 30 --camera-elevation 10 -o "
      "track.csv");
  command->callback([&context, options] {
    context.run = [&context, options] { run_project(context, *options); };
  });
}

}  // namespace mcdbn::cli
