#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/counted.hpp"
#include "base/interruption.hpp"
#include "base/output_file.hpp"
#include "base/shown.hpp"
#include "camera_options.hpp"
#include "commands.hpp"
#include "comparison/report_clips.hpp"
#include "comparison/training_views.hpp"
#include "default_model.hpp"
#include "detector_options.hpp"
#include "evaluation/report_page.hpp"
#include "fit_option.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/corpus/clip.hpp"
#include "mcdbn/formats/joint_map.hpp"
#include "mcdbn/motion/humanoid.hpp"
#include "progress.hpp"
#include "sampling_options.hpp"
#include "setting_flags.hpp"

namespace mcdbn::cli {
namespace {

constexpr std::size_t kPaperSamples = 10;  // regenerations of each clip, section V
constexpr double kPaperTemperature = 1.0;  // drawn as the model draws them
constexpr const char *kExact = "exact", *kDetector = "detector";
constexpr double kTestShare = 0.9;  // of the time, about; the rest goes to the distributions' fits

struct EvaluateOptions {
  std::filesystem::path model, report;
  std::vector<std::filesystem::path> test;
  std::string protocol = "subject", actions, fit;
  std::string tracks = kExact, like = "openpose";
  DetectorCameras cameras;
  OtherBody people;
  std::vector<const CLI::Option*> of_detector, of_exact;  ///< to check whether they were given
  bool camera_unknown = false, baselines_given = false;
  TestRunOptions run;
  SamplingOptions sampling;
  std::optional<double> azimuth_deg, elevation_deg;
  std::size_t uncertainty_draws = kUncertaintyDraws;
};

/// Fills in the protocol's defaults; options that were given stay.
/// `paper` is section V: every clip, those trained on too, regenerated ten times by the network
/// alone.
void apply_protocol(EvaluateOptions& options) {
  const bool paper = options.protocol == "paper";
  options.run.include_training |= paper;
  if (options.actions.empty()) options.actions = paper ? "by-folder" : "together";
  if (options.fit.empty()) options.fit = paper ? kFitNone : kFitTrack;
  options.run.fit = track_fit(options.fit);
  if (!paper) return;
  SamplingOptions& sampling = options.sampling;
  sampling.samples = sampling.samples.value_or(kPaperSamples);
  sampling.temperature = sampling.temperature.value_or(kPaperTemperature);
}

/// @throws ConfigError naming an option that is of the other kind of tracks
void check_tracks(const EvaluateOptions& options) {
  const bool exact = options.tracks == kExact;
  for (const CLI::Option* option : exact ? options.of_detector : options.of_exact)
    if (option->count() > 0)
      throw ConfigError(
          fmt::format("{} is for --tracks {}", option->get_name(), exact ? kDetector : kExact));
}

/// The tracks that every method is to see.
void choose_tracks(EvaluateOptions& options) {
  if (options.tracks == kDetector) {
    options.run.detector = detector_like(options.like);
    options.run.detector->cameras = options.cameras;
    options.run.detector->body = options.people;
  }
  options.run.camera_known = !options.camera_unknown;
}

/// @throws ConfigError if the joint map would do nothing
void check_joint_map(const Model& model, const EvaluateOptions& options) {
  if (!options.run.joint_map.empty() && !is_humanoid(model.modalities.pose_features.skeleton()))
    throw ConfigError(
        "--joint-map is for models of the canonical humanoid, and this one is of its clips' own "
        "skeleton; leave it out");
}

/// What compares with other programs and with detectors' joints.
void print_limbs(const EvaluationReport& report) {
  fmt::print("\n{:<22}{:>10}{:>14}{:>8}   limbs, mm\n", "", "MPJPE", "one rotation", "PA");
  for (const MethodReport& method : overall_methods(report)) {
    const LimbError& limbs = method.mean.limbs;
    fmt::print("{:<22}{:>10.1f}{:>14.1f}{:>8.1f}\n", method.name, limbs.mpjpe_mm,
               limbs.turned_mpjpe_mm, limbs.pa_mpjpe_mm);
  }
}

/// The share of 90 % intervals that hold the truth; the JSON has it for each joint and channel.
void print_coverage(const EvaluationReport& report) {
  if (report.joints.empty()) return;
  const auto by_share = [](const auto& x, const auto& y) {
    return x.second.share() < y.second.share();
  };
  const auto& joints = report.joints.by_name();
  const auto worst = std::min_element(joints.begin(), joints.end(), by_share);
  fmt::print("\n90 % intervals that hold the truth: of joints {:.1f} % ({} {:.1f} %)",
             100 * report.joints.overall().share(), printable(worst->first),
             100 * worst->second.share());
  if (!report.channels.empty())
    fmt::print(", of the network's channels {:.1f} %", 100 * report.channels.overall().share());
  fmt::print("\n");
}

void print_table(const EvaluationReport& report) {
  int frames = 0;
  for (const ReportClip& clip : report.clips) frames += clip.frames();
  fmt::print("{}, {}\n{:<22}{:>10}{:>12}{:>11}{:>14}{:>10}\n", counted(report.clips.size(), "clip"),
             counted(frames, "frame"), "", "PCC flat", "PCC channel", "MPJPE mm", "PA-MPJPE mm",
             "root mm");
  for (const MethodReport& method : overall_methods(report)) {
    const double root_mm = method.mean.root_mm;
    fmt::print("{:<22}{:>10.4f}{:>12.3f}{:>11.1f}{:>14.1f}{:>10}\n", method.name,
               method.mean.pcc_flat, method.mean.pcc_channel, method.mean.error.mpjpe_mm,
               method.mean.error.pa_mpjpe_mm,
               std::isfinite(root_mm) ? fmt::format("{:.0f}", root_mm) : "-");
  }
  if (report.tracks != kExact) print_limbs(report);
  print_coverage(report);
  const TrackError track = overall_track_error(report);
  fmt::print(
      "\n2D from 3D: joints {:.1f} px off, relative to the root (the mean track {:.1f} px)\n\n",
      track.track_error_px, track.mean_track_error_px);
  for (const Verdict& verdict : verdicts(report))
    fmt::print("{} {}\n",
               verdict.kind == Verdict::Kind::good  ? "+"
               : verdict.kind == Verdict::Kind::bad ? "-"
                                                    : " ",
               printable(verdict.text));
}

/// Leaves out the simpler methods where the training clips that they are fitted on are not here, as
/// for the model that comes with the program.
void leave_out_baselines(const Model& model, EvaluateOptions& options) {
  const bool gone = std::ranges::any_of(model.training_clips, [](const TrainingClip& clip) {
    return !std::filesystem::exists(clip.path);
  });
  if (!options.model.empty() || options.baselines_given || !gone) return;
  options.run.baselines.clear();
  spdlog::warn("no simpler methods beside the model: its training clips are not here");
}

/// What run_test takes: the model's camera, unless options change it, and its samples.
TestRunOptions test_options_of(const Model& model, const EvaluateOptions& options,
                               std::uint64_t seed) {
  TestRunOptions run = options.run;
  run.camera = model.modalities.camera;
  if (options.azimuth_deg) run.camera.azimuth_deg = *options.azimuth_deg;
  if (options.elevation_deg) run.camera.elevation_deg = *options.elevation_deg;
  run.regeneration = options.sampling.regeneration(model.network, seed);
  run.uncertainty_draws = {options.uncertainty_draws, seed};
  add_training_views(model, run);
  run.notices = [](const std::string& notice) { spdlog::warn("{}", with_flags(notice)); };
  return run;
}

/// Runs the test and analyses its results.
EvaluationReport evaluated_report(const CommandContext& context, const Model& model,
                                  const EvaluateOptions& options) {
  ProgressLine progress(context.quiet);
  const auto show = [&](double from, double to) {
    return [&, from, to](const std::string& what, double fraction) {
      check_interruption();
      progress.show(what, from + (to - from) * fraction);
    };
  };
  TestRunOptions run = test_options_of(model, options, context.seed);
  run.progress = show(0.0, kTestShare);
  EvaluationReport report;
  report.temperature = run.regeneration.temperature;
  const std::vector<ClipResult> results = run_test(model, find_clips(options.test), run);
  for (const ClipResult& result : results) {
    report.joints.add(result.joints);
    report.channels.add(result.channels);
  }
  report.clips = report_clips(model, results, options.actions == "by-folder");
  report.actions = analyse_actions(report.clips, context.seed, show(kTestShare, 1.0));
  report.protocol = options.protocol;
  report.fit = options.fit;
  report.tracks = options.tracks == kDetector ? options.like : options.tracks;
  report.camera_known = options.run.camera_known;
  report.damage = options.run.damage;
  return report;
}

/// Writes the report's folder, if one was asked for, and prints the figures.
void publish(const CommandContext& context, const EvaluationReport& report,
             const std::filesystem::path& folder) {
  if (!folder.empty()) {
    write_report(folder, report);
    spdlog::info("{}: open report.html in a browser", folder.string());
  }
  if (context.json)
    print_json(summary_json(report));
  else
    print_table(report);
}

void run_evaluate(const CommandContext& context, EvaluateOptions options) {
  apply_protocol(options);
  check_tracks(options);
  choose_tracks(options);
  if (!options.report.empty()) make_folder(options.report);  // before the work
  Device device = Device::open({context.platform, context.device});
  const std::filesystem::path model_file = model_or_default(options.model);
  const Model model = load_model(device, model_file);
  check_joint_map(model, options);
  leave_out_baselines(model, options);
  EvaluationReport report = evaluated_report(context, model, options);
  report.model = model_file.filename().string();
  publish(context, report, options.report);
}

void add_test_options(CLI::App& command, EvaluateOptions& options) {
  add_model_option(command, options.model);
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
                  "those trained on, 10 samples at temperature 1, by folder")
      ->check(CLI::IsMember({"subject", "paper"}))
      ->capture_default_str();
  command
      .add_option("--actions", options.actions,
                  "together, or by-folder: each folder's name is an action")
      ->check(CLI::IsMember({"together", "by-folder"}));
  command
      .add_option_function<std::vector<std::string>>(
          "--baselines",
          [&options](const std::vector<std::string>& words) {
            options.run.baselines = baselines_of(words);
            options.baselines_given = true;
          },
          "Simpler methods to score beside the model: usual, all (related systems too, which take "
          "minutes), none, or names: " +
              fmt::format("{}", fmt::join(all_baselines(), ",")))
      ->delimiter(',')
      ->default_str("usual")
      ->type_name("NAME,...");
  command.add_flag("--include-training", options.run.include_training,
                   "Accept clips that were trained on");
  command.add_flag("--keep-first-frame", options.run.keep_first_frame,
                   "Keep a leading calibration pose");
  command
      .add_option_function<std::filesystem::path>(
          "--joint-map",
          [&options](const std::filesystem::path& file) {
            options.run.joint_map = read_joint_map(file);
          },
          "TOML file of role = \"joint name\", for a model of the canonical humanoid and clips "
          "whose joint names do not show the roles; `train` takes it too (docs/joints.md)")
      ->type_name("FILE");
}

void add_regeneration_options(CLI::App& command, EvaluateOptions& options) {
  add_sampling_options(command, options.sampling,
                       "Regenerations of each clip (default: 1; 10 with --protocol paper)");
  CLI::Option* temperature = command.get_option("--temperature");
  temperature->description(temperature->get_description() + "; 1 with --protocol paper");
  add_fit_option(command, options.fit, "default: track, none in the paper's protocol; all methods");
  command
      .add_option("--uncertainty-draws", options.uncertainty_draws,
                  "Motions drawn from each clip's posterior, to estimate the uncertainty of the "
                  "model's single answer and how often its intervals hold the truth; 0: skip this")
      ->check(in_range(within(0, 10000)))
      ->capture_default_str();
  add_view_flags(command, options.azimuth_deg, options.elevation_deg);
  for (const char* flag : {"--camera-azimuth", "--camera-elevation"})
    options.of_exact.push_back(command.get_option(flag));
}

void add_track_options(CLI::App& command, EvaluateOptions& options) {
  constexpr const char* kGroup = "2D tracks";
  command
      .add_option(
          "--tracks", options.tracks,
          "exact: the clips' own joints through the model's view; detector: what a detector "
          "would see of another person with the same motion, through cameras drawn around them")
      ->check(CLI::IsMember({kExact, kDetector}))
      ->capture_default_str()
      ->group(kGroup);
  CLI::Option* like = command
                          .add_option("--like", options.like,
                                      "With --tracks detector: its name (" + detector_names() +
                                          "), or a track file that it wrote")
                          ->capture_default_str()
                          ->type_name("NAME|FILE")
                          ->group(kGroup);
  options.of_detector.push_back(like);
  command
      .add_flag("--camera-unknown", options.camera_unknown,
                "Hide the camera's place and lens from every method")
      ->group(kGroup);
  visit_group("person", options.people, [&](const Setting& setting, double& value) {
    options.of_detector.push_back(
        add_setting_flag(command, flag_of(setting.name), setting, value)->group(kGroup));
  });
  for (const CLI::Option* option : add_detector_camera_flags(command, options.cameras))
    options.of_detector.push_back(option);
}

/// Trackers' faults, applied to the test clips' tracks before any method sees them.
void add_damage_options(CLI::App& command, TrackDamage& damage) {
  visit_group("track", damage, [&](const Setting& setting, double& value) {
    add_setting_flag(command, flag_of(setting.name), setting, value)
        ->group("Damage to the 2D tracks, by --seed");
  });
}

}  // namespace

void add_evaluate_command(CLI::App& app, CommandContext& context) {
  auto options = std::make_shared<EvaluateOptions>();
  CLI::App* command = app.add_subcommand(
      "evaluate", "Scores a model and its baselines on clips that it was not trained on");
  add_test_options(*command, *options);
  add_regeneration_options(*command, *options);
  add_track_options(*command, *options);
  add_damage_options(*command, options->run.damage);
  add_json_option(*command, context);
  add_seed_option(*command, context);
  add_device_options(*command, context);
  add_quiet_option(*command, context);
  command->footer(
      "Example:\n  mcdbn-cl evaluate --model run/model.safetensors --test held_out/ --report "
      "report\n"
      "  mcdbn-cl evaluate --model run/model.safetensors --test held_out/ --json\n"
      "  mcdbn-cl evaluate --model run/model.safetensors --test held_out/ --tracks detector");
  run_with(*command, context, options, run_evaluate);
}

}  // namespace mcdbn::cli
