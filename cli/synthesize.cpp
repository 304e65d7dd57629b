#include "mcdbn/synthesis/synthesize.hpp"

#include <spdlog/spdlog.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/counted.hpp"
#include "base/interruption.hpp"
#include "commands.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "setting_flags.hpp"

namespace mcdbn::cli {
namespace {

namespace fs = std::filesystem;

struct SynthesizeOptions {
  std::string action;
  int clips = 10;
  int subjects = 5;
  double fps = SynthesisOptions{}.fps;
  double seconds = SynthesisOptions{}.seconds;
  fs::path output;
};

/// Clips go round the subjects, so that each subject has about as many.
void run_synthesize(const CommandContext& context, const SynthesizeOptions& options) {
  SynthesisOptions clip{.action = parse_synthesis_action(options.action)};
  clip.seed = context.seed;
  clip.fps = options.fps;
  clip.seconds = options.seconds;
  for (int i = 0; i < options.clips; ++i) {
    check_interruption();
    clip.subject = 1 + i % options.subjects;
    clip.clip = 1 + i / options.subjects;
    const Motion motion = synthesize(clip);
    if (i == 0) make_folder(options.output);
    write_bvh(options.output / synthesis_file_name(clip), motion);
  }
  spdlog::info("{}: {} of {} by {}, {:.4g} s each at {:.4g} fps", options.output.string(),
               counted(options.clips, "clip"), options.action,
               counted(std::min(options.clips, options.subjects), "subject"), options.seconds,
               options.fps);
}

std::vector<std::string> action_names() {
  std::vector<std::string> names;
  for (const SynthesisAction action : synthesis_actions()) {
    names.emplace_back(synthesis_action_name(action));
  }
  return names;
}

}  // namespace

void add_synthesize_command(CLI::App& app, CommandContext& context) {
  constexpr double kMostFiles = 1e5;
  auto options = std::make_shared<SynthesizeOptions>();
  CLI::App* command =
      app.add_subcommand("synthesize", "Writes clips of parametric human motion as BVH");
  command->add_option("--action", options->action, "Action that the figure performs")
      ->required()
      ->check(CLI::IsMember(action_names()));
  command->add_option("--clips", options->clips, "Number of clips")
      ->check(in_range(within(1, kMostFiles)))
      ->capture_default_str();
  command
      ->add_option("--subjects", options->subjects,
                   "Number of people; a person's body and style are the same in every action")
      ->check(in_range(within(1, kMostFiles)))
      ->capture_default_str();
  command->add_option("--seconds", options->seconds, "Length of a clip")->capture_default_str();
  command->add_option("--fps", options->fps, "Frames a second")->capture_default_str();
  command
      ->add_option("-o,--output", options->output,
                   "Folder to write ACTION_sSUBJECT_CLIP.bvh files to")
      ->required()
      ->type_name("DIR");
  add_seed_option(*command, context);
  add_quiet_option(*command, context);
  command->footer("Example:\n  mcdbn-cl synthesize --action walk --clips 20 --seed 1 -o clips/");
  run_with(*command, context, options, run_synthesize);
}

}  // namespace mcdbn::cli
