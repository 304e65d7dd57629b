#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "comparison/comparison_run.hpp"
#include "evaluation/report_page.hpp"
#include "fit_option.hpp"
#include "interrupt.hpp"
#include "mcdbn/corpus/clip.hpp"
#include "mcdbn/motion_model/training_schedule.hpp"
#include "progress.hpp"
#include "sampling_options.hpp"
#include "training_options.hpp"

namespace mcdbn::cli {
namespace {

constexpr std::size_t kPaperSamples = 10;

struct EvaluateOptions {
  std::filesystem::path model, report;
  std::vector<std::filesystem::path> test;
  std::string protocol = "subject", actions, fit;
  TestRunOptions run;
  SamplingOptions sampling;
  std::optional<double> azimuth_deg, elevation_deg;
};

/// What the protocol leaves open is filled in; what was said stays.
/// `paper` is section V: every clip, those trained on too, regenerated ten times by the network
/// alone.
void apply_protocol(EvaluateOptions& options) {
  const bool paper = options.protocol == "paper";
  options.run.include_training |= paper;
  if (options.actions.empty()) options.actions = paper ? "by-folder" : "together";
  if (options.fit.empty()) options.fit = paper ? kFitNone : kFitTrack;
  options.run.fit = track_fit(options.fit);
}

void print_table(const EvaluationReport& report) {
  int frames = 0;
  for (const ReportClip& clip : report.clips) frames += clip.frames();
  fmt::print("{} clips, {} frames\n{:<20}{:>10}{:>12}{:>11}{:>14}{:>10}\n", report.clips.size(),
             frames, "", "PCC flat", "PCC channel", "MPJPE mm", "PA-MPJPE mm", "root mm");
  for (const MethodReport& method : overall_methods(report))
    fmt::print("{:<20}{:>10.4f}{:>12.3f}{:>11.1f}{:>14.1f}{:>10.0f}\n", method.name,
               method.mean.pcc_flat, method.mean.pcc_channel, method.mean.error.mpjpe_mm,
               method.mean.error.pa_mpjpe_mm, method.mean.root_mm);
  fmt::print("\n");
  for (const Verdict& verdict : verdicts(report))
    fmt::print("{} {}\n",
               verdict.kind == Verdict::Kind::good  ? "+"
               : verdict.kind == Verdict::Kind::bad ? "-"
                                                    : " ",
               verdict.text);
}

/// The views that the model's fine-tuning learnt from, made again, for the MLP to learn from too.
void add_views(const Model& model, TestRunOptions& run) {
  const TrainingConfig config = settings_from_json(model.config);
  if (config.fine_tuning.steps == 0) return;
  std::vector<std::filesystem::path> files;
  for (const TrainingClip& clip : model.training_clips) {
    if (!std::filesystem::exists(clip.path)) return;  // run_test says so
    if (files.empty() || files.back() != clip.path) files.emplace_back(clip.path);
  }
  TrainingSet views =
      make_augmented_views(load_clips(files, config.keep_first_frame), model.modalities, config);
  run.view_tracks = std::move(views.tracks);
  run.view_poses = std::move(views.poses);
}

void run_evaluate(const CommandContext& context, EvaluateOptions options) {
  apply_protocol(options);
  Device device = Device::open({context.platform, context.device});
  const Model model = load_model(device, options.model);
  const InterruptGuard interrupt;
  EvaluationReport report;
  {
    ProgressLine progress(context.quiet);
    const auto show = [&](double from, double to) {
      return [&, from, to](const std::string& what, double fraction) {
        interrupt.check();
        progress.show(what, from + (to - from) * fraction);
      };
    };
    TestRunOptions run = options.run;
    run.camera = model.modalities.camera;
    if (options.azimuth_deg) run.camera.azimuth_deg = *options.azimuth_deg;
    if (options.elevation_deg) run.camera.elevation_deg = *options.elevation_deg;
    run.regeneration = options.sampling.regeneration(
        model.network, context.seed, options.protocol == "paper" ? kPaperSamples : 1);
    report.temperature = run.regeneration.temperature;
    add_views(model, run);
    run.progress = show(0.0, 0.9);
    report.clips = report_clips(model, run_test(model, find_clips(options.test), run),
                                options.actions == "by-folder");
    report.actions = analyse_actions(report.clips, context.seed, show(0.9, 1.0));
  }
  report.model = options.model.filename().string();
  report.protocol = options.protocol;
  report.fit = options.fit;
  report.damage = options.run.damage;
  if (!options.report.empty()) {
    write_report(options.report, report);
    spdlog::info("{}: open report.html in a browser", options.report.string());
  }
  if (context.json)
    print_json(summary_json(report));
  else
    print_table(report);
}

void add_test_options(CLI::App& command, EvaluateOptions& options) {
  command.add_option("--model", options.model, "Trained model")->required()->type_name("FILE");
  command.add_option("--test", options.test, "BVH files, or folders that hold some")
      ->required()
      ->type_name("PATH");
  command
      .add_option("--report", options.report,
                  "Folder to write report.html, summary.json and the tables (CSV) to")
      ->type_name("DIR");
  command
      .add_option("--protocol", options.protocol,
                  "subject: clips of people that were not trained on; paper: every clip, also "
                  "those trained on, 10 samples, by folder")
      ->check(CLI::IsMember({"subject", "paper"}))
      ->capture_default_str();
  command
      .add_option("--actions", options.actions,
                  "together, or by-folder: each folder's name is an action")
      ->check(CLI::IsMember({"together", "by-folder"}));
  command.add_flag("--include-training", options.run.include_training,
                   "Accept clips that were trained on");
  command.add_flag("--keep-first-frame", options.run.keep_first_frame,
                   "Keep a leading calibration pose");
}

void add_regeneration_options(CLI::App& command, EvaluateOptions& options) {
  add_sampling_options(command, options.sampling, "Regenerations of each clip (default: 1)");
  add_fit_option(command, options.fit, "default: track, none in the paper's protocol; all methods");
  command.add_option("--camera-azimuth", options.azimuth_deg, "Degrees (default: as trained)");
  command.add_option("--camera-elevation", options.elevation_deg, "Degrees (default: as trained)")
      ->check(CLI::Range(-89.0, 89.0));
}

/// What trackers do to a track, done to the test clips' before any method sees them.
void add_damage_options(CLI::App& command, TrackDamage& damage) {
  constexpr const char* kGroup = "Damage to the 2D tracks, by --seed";
  command
      .add_option("--track-noise-px", damage.noise_px, "Gaussian noise on x and y, deviation in px")
      ->check(CLI::NonNegativeNumber)
      ->group(kGroup);
  command
      .add_option("--track-missing", damage.missing_share,
                  "Share of the joints of each frame that go missing, each on its own")
      ->check(CLI::Range(0.0, 1.0))
      ->type_name("SHARE")
      ->group(kGroup);
  command
      .add_option("--track-hide", damage.hidden_s,
                  "Hide an arm for so long in the middle of each clip")
      ->check(CLI::NonNegativeNumber)
      ->type_name("SECONDS")
      ->group(kGroup);
}

}  // namespace

void add_evaluate_command(CLI::App& app, CommandContext& context) {
  auto options = std::make_shared<EvaluateOptions>();
  CLI::App* command = app.add_subcommand(
      "evaluate", "Scores a model and its baselines on clips that it was not trained on");
  add_test_options(*command, *options);
  add_regeneration_options(*command, *options);
  add_damage_options(*command, options->run.damage);
  add_json_option(*command, context);
  add_seed_option(*command, context);
  add_device_options(*command, context);
  add_quiet_option(*command, context);
  command->footer(
      "Example:\n  mcdbn-cl evaluate --model run/model.safetensors --test held_out/ --report "
      "report\n"
      "  mcdbn-cl evaluate --model run/model.safetensors --test held_out/ --json");
  command->callback([&context, options] {
    context.run = [&context, options] { run_evaluate(context, *options); };
  });
}

}  // namespace mcdbn::cli
