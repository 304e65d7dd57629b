#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <vector>

#include "base/counted.hpp"
#include "clip_options.hpp"
#include "commands.hpp"
#include "default_model.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "mcdbn/machines/size_limits.hpp"
#include "mcdbn/motion_model/clip_generation.hpp"
#include "mcdbn/motion_model/settings_record.hpp"
#include "output_ending.hpp"
#include "sample_path.hpp"
#include "setting_flags.hpp"

namespace mcdbn::cli {
namespace {

/// Usual temperature. At 1, five of 172 sequences of 33 s that follow walks of training subjects
/// end at less than half their clip's speed; at 2, none does (docs/generation.md).
constexpr double kUsualTemperature = 2.0;

struct GenerateOptions {
  std::filesystem::path model, output;
  std::vector<std::filesystem::path> seed_clips;
  double seed_every_s = 0;
  GenerationOptions generation{.temperature = kUsualTemperature};
};

std::vector<SeedClip> load_seeds(const GenerateOptions& options, double fps) {
  std::vector<SeedClip> seeds;
  for (const std::filesystem::path& file : options.seed_clips)
    seeds.push_back(
        {file.string(), load_clip_with_notices(file, {.fps = fps}), options.seed_every_s});
  return seeds;
}

/// Whether its 3D CDBN was trained with noise on histories: else it has never seen its own output.
bool learnt_to_run_freely(const Model& model) {
  return settings_from_json(model.config).gaussian.history_noise > 0;
}

/// Reports whether the motion stays bounded and keeps moving. One person's channels may deviate
/// less than those of all people in training: where few are in range, only a model that did not
/// learn to run freely is to blame.
void report(const GenerationHealth& health, bool can_run_freely) {
  constexpr double kLeast = 0.5, kMost = 1.5;  // shares of the training data's deviation
  std::vector<double> deviation(health.deviation.begin(), health.deviation.end());
  std::sort(deviation.begin(), deviation.end());
  const std::size_t cycle = health.shortest_of_cycles();
  spdlog::info(
      "its channels deviate {:.2f} to {:.2f} times as far as in training (median {:.2f}); {}",
      deviation.front(), deviation.back(), deviation[deviation.size() / 2],
      cycle > 0 ? fmt::format("the shortest cycle has {}", counted(cycle, "frame")) : "no cycle");
  const auto in_range = static_cast<std::size_t>(std::ranges::count_if(
      deviation, [](double of_channel) { return of_channel >= kLeast && of_channel <= kMost; }));
  spdlog::info(
      "{} of {} between {:g} and {:g}; {} of {} slower than half the clip's speed in the end",
      in_range, counted(deviation.size(), "channel"), kLeast, kMost, health.slow_sequences(),
      counted(health.late_speed.size(), "sequence"));
  if (!can_run_freely && 2 * in_range < deviation.size())
    spdlog::warn(
        "only {} of {} deviate {:g} to {:g} times as far as in training: the model was not trained "
        "to run freely; train one with `train --preset generation`",
        in_range, counted(deviation.size(), "channel"), kLeast, kMost);
}

void run_generate(const CommandContext& context, const GenerateOptions& options) {
  check_ending(options.output, {".bvh"});
  Device device = Device::open({context.platform, context.device});
  const Model model = load_model(device, model_or_default(options.model));
  const bool can_run_freely = learnt_to_run_freely(model);
  GenerationOptions generation = options.generation;
  generation.seed = context.seed;
  GenerationHealth health;
  const auto motions =
      generate_clips(model, load_seeds(options, model.modalities.fps), generation, &health);
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const auto path = sample_path(options.output, i, motions.size());
    write_bvh(path, motions[i]);
    spdlog::info("{}: {} at {:.4g} fps", path.string(), counted(motions[i].frames(), "frame"),
                 motions[i].fps());
  }
  report(health, can_run_freely);
}

}  // namespace

void add_generate_command(CLI::App& app, CommandContext& context) {
  constexpr double kMostFrames = 1e6, kMostSamples = 1000, kHottest = 10, kLeastSeconds = 0.1,
                   kMostSeconds = 1e6;
  auto options = std::make_shared<GenerateOptions>();
  GenerationOptions& generation = options->generation;
  CLI::App* command = app.add_subcommand(
      "generate", "Continues a clip where it ends: new 3D motion, as BVH, without any track");
  add_model_option(*command, options->model)
      ->description(
          "Model of `train --preset generation` (default: the general one that comes with the "
          "program, which was not trained to run freely)");
  command
      ->add_option("--seed-clip", options->seed_clips,
                   "BVH clip to continue from its last frames, with its person's proportions; "
                   "several are continued one after another")
      ->required()
      ->type_name("FILE");
  command
      ->add_option(
          "--seed-every", options->seed_every_s,
          "Continue from several moments of a clip, this far apart (default: from its end only)")
      ->check(in_range(within(kLeastSeconds, kMostSeconds)))
      ->type_name("SECONDS");
  mark_output(
      command->add_option("-o,--output", options->output, "BVH file to write: the new frames"),
      context)
      ->required()
      ->type_name("FILE");
  command->add_option("--frames", generation.frames, "New frames, at the model's rate")
      ->check(in_range(within(1, kMostFrames)))
      ->capture_default_str();
  command
      ->add_option("--samples", generation.samples,
                   "Variations of each; several are written as out_01.bvh …")
      ->check(in_range(within(1, kMostSamples)))
      ->capture_default_str();
  command
      ->add_option("--temperature", generation.temperature,
                   "How far hidden units are drawn from their mean: 0: not at all, 1: as the model "
                   "defines it; 2 keeps walkers walking")
      ->check(in_range(within(0, kHottest)))
      ->capture_default_str();
  command
      ->add_option("--gibbs-steps", generation.gibbs_steps,
                   "Drawn steps of the top layer in each frame (k of Algorithm 4)")
      ->check(in_range(size_limits::kGibbsSteps))
      ->capture_default_str();
  add_seed_option(*command, context);
  add_device_options(*command, context);
  add_quiet_option(*command, context);
  command->footer(
      "Example:\n  mcdbn-cl generate --model run/model.safetensors --seed-clip walk.bvh -o out.bvh "
      "--frames 1000");
  run_with(*command, context, options, run_generate);
}

}  // namespace mcdbn::cli
