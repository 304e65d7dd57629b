#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "mcdbn/motion/clip.hpp"
#include "mcdbn/regeneration/test_run.hpp"

namespace mcdbn::cli {
namespace {

using nlohmann::ordered_json;

struct EvaluateOptions {
  std::filesystem::path model;
  std::vector<std::filesystem::path> test;
  TestRunOptions run;
  std::optional<double> azimuth_deg, elevation_deg;
};

ordered_json score_json(const ClipScore& score) {
  return {{"pcc_flat", score.pcc_flat},
          {"pcc_channel", score.pcc_channel},
          {"mpjpe_mm", score.error.mpjpe_mm},
          {"pa_mpjpe_mm", score.error.pa_mpjpe_mm},
          {"mpjve_mm_s", score.error.mpjve_mm_s},
          {"acceleration_error_mm_s2", score.error.acceleration_error_mm_s2},
          {"pck_150mm", score.error.pck_150mm},
          {"root_mm", score.root_mm}};
}

ordered_json summary_json(const std::vector<ClipResult>& results) {
  std::vector<ClipScore> model;
  std::map<std::string, std::vector<ClipScore>> baselines;
  int frames = 0;
  for (const ClipResult& result : results) {
    frames += result.truth.motion.frames();
    model.insert(model.end(), result.scores.begin(), result.scores.end());
    for (const auto& [name, score] : result.baseline_scores) baselines[name].push_back(score);
  }
  ordered_json summary = {
      {"clips", results.size()}, {"frames", frames}, {"model", score_json(mean_score(model))}};
  summary["baselines"] = ordered_json::object();
  for (const auto& [name, scores] : baselines)
    summary["baselines"][name] = score_json(mean_score(scores));
  return summary;
}

void print_table(const ordered_json& summary) {
  fmt::print("{} clips, {} frames\n{:<20}{:>10}{:>12}{:>11}{:>14}{:>10}\n",
             summary["clips"].get<int>(), summary["frames"].get<int>(), "", "PCC flat",
             "PCC channel", "MPJPE mm", "PA-MPJPE mm", "root mm");
  const auto row = [](const std::string& name, const ordered_json& score) {
    fmt::print("{:<20}{:>10.4f}{:>12.3f}{:>11.1f}{:>14.1f}{:>10.0f}\n", name,
               score["pcc_flat"].get<double>(), score["pcc_channel"].get<double>(),
               score["mpjpe_mm"].get<double>(), score["pa_mpjpe_mm"].get<double>(),
               score["root_mm"].get<double>());
  };
  row("model", summary["model"]);
  for (const auto& [name, score] : summary["baselines"].items()) row(name, score);
}

void run_evaluate(const CommandContext& context, const EvaluateOptions& options) {
  Device device = Device::open({context.platform, context.device});
  const Model model = load_model(device, options.model);
  TestRunOptions run = options.run;
  run.camera = model.modalities.camera;
  if (options.azimuth_deg) run.camera.azimuth_deg = *options.azimuth_deg;
  if (options.elevation_deg) run.camera.elevation_deg = *options.elevation_deg;
  run.regeneration.seed = context.seed;
  const ordered_json summary = summary_json(run_test(model, find_clips(options.test), run));
  if (context.json)
    print_json(summary);
  else
    print_table(summary);
}

}  // namespace

void add_evaluate_command(CLI::App& app, CommandContext& context) {
  auto options = std::make_shared<EvaluateOptions>();
  CLI::App* command = app.add_subcommand(
      "evaluate", "Scores a model and its baselines on clips that it was not trained on");
  command->add_option("--model", options->model, "Trained model")->required()->type_name("FILE");
  command->add_option("--test", options->test, "BVH files, or folders that hold some")
      ->required()
      ->type_name("PATH");
  command->add_flag("--include-training", options->run.include_training,
                    "Accept clips that were trained on");
  command->add_flag("--keep-first-frame", options->run.keep_first_frame,
                    "Keep a leading calibration pose");
  command->add_option("--samples", options->run.regeneration.samples, "Regenerations of each clip")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command
      ->add_option("--temperature", options->run.regeneration.temperature,
                   "0: mean field; towards 1: sampled")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  command->add_option("--camera-azimuth", options->azimuth_deg, "Degrees (default: as trained)");
  command->add_option("--camera-elevation", options->elevation_deg, "Degrees (default: as trained)")
      ->check(CLI::Range(-89.0, 89.0));
  add_json_option(*command, context);
  add_seed_option(*command, context);
  add_device_options(*command, context);
  add_quiet_option(*command, context);
  command->footer(
      "Example:\n  mcdbn-cl evaluate --model run/model.safetensors --test held_out/ --json");
  command->callback([&context, options] {
    context.run = [&context, options] { run_evaluate(context, *options); };
  });
}

}  // namespace mcdbn::cli
