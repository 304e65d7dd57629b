// Every option of evaluate, and what it changes: compared with the library's own run.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <tuple>

#include "base/text_file.hpp"
#include "comparison/comparison_run.hpp"
#include "comparison/report_clips.hpp"
#include "evaluation/evaluation_report.hpp"
#include "library_calls.hpp"
#include "mcdbn/camera/joint_sets.hpp"
#include "mcdbn/motion_model/training_schedule.hpp"
#include "option_table.hpp"
#include "tiny_pipeline.hpp"

namespace evaluate_options_test {

using namespace mcdbn::test;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

/// What may be given; the library's run takes the same.
struct Call {
  fs::path model = {};
  std::vector<fs::path> test = {};
  bool by_folder = false, keep_first_frame = false, include_training = false, fit = true;
  std::size_t samples = 1;
  double temperature = 0;
  std::optional<mcdbn::SamplingRule> sampling = {};
  std::uint64_t seed = 1;
  double azimuth_deg = 30, elevation_deg = 10;  // as the tiny model was trained
  mcdbn::TrackDamage damage = {};
  std::string like = {};  // empty: exact tracks
  mcdbn::DetectorCameras cameras = {};
  mcdbn::OtherBody people = {};
  bool camera_known = true;
  std::size_t uncertainty_draws = 0;  // the program's own, 50, takes its time
};

/// Views of the training clips, for the MLP among the baselines to learn from.
struct Views {
  std::vector<mcdbn::MatrixF> tracks = {}, poses = {};
};

/// The summary; without the baselines, which take longer than all the rest, unless there are
/// views for them.
json by_library(const Call& call, const std::optional<Views>& views = {}) {
  const mcdbn::Model model = load_model(usual_device(), call.model);
  mcdbn::TestRunOptions options;
  options.camera = model.modalities.camera;
  options.camera.azimuth_deg = call.azimuth_deg;
  options.camera.elevation_deg = call.elevation_deg;
  options.regeneration.samples = call.samples;
  options.regeneration.temperature = call.temperature;
  options.regeneration.seed = call.seed;
  options.regeneration.sampling = call.sampling.value_or(model.network.sampling);
  if (!call.fit) options.fit.reset();
  options.uncertainty_draws = {call.uncertainty_draws, call.seed};
  options.damage = call.damage;
  options.camera_known = call.camera_known;
  for (const mcdbn::Detector& detector : mcdbn::detectors())
    if (call.like == detector.name)
      options.detector = {mcdbn::joint_set(detector.joint_set).keypoints, detector.noise,
                          call.cameras, call.people};
  options.keep_first_frame = call.keep_first_frame;
  options.include_training = call.include_training;
  if (!views) options.baselines.clear();
  if (views) {
    options.view_tracks = views->tracks;
    options.view_poses = views->poses;
  }
  mcdbn::EvaluationReport report;
  const auto results = run_test(model, call.test, options);
  for (const mcdbn::ClipResult& result : results) {
    report.joints.add(result.joints);
    report.channels.add(result.channels);
  }
  report.clips = report_clips(model, results, call.by_folder);
  report.actions = analyse_actions(report.clips, call.seed);
  report.temperature = call.temperature;
  report.fit = call.fit ? "track" : "none";
  report.damage = call.damage;
  report.tracks = call.like.empty() ? "exact" : call.like;
  report.camera_known = call.camera_known;
  return json(summary_json(report));
}

/// The views that the tiny model's fine-tuning learnt from.
Views views_of_training(const fs::path& model) {
  const TinyPipeline& pipeline = TinyPipeline::instance();
  mcdbn::TrainingConfig config;
  config.augment.views = 1;  // as in kTiny
  mcdbn::TrainingSet views =
      make_augmented_views(mcdbn::load_clips({pipeline.motion() / "walk_s01_01.bvh",
                                              pipeline.motion() / "walk_s01_02.bvh"}),
                           load_model(usual_device(), model).modalities, config);
  return {std::move(views.tracks), std::move(views.poses)};
}

/// What both know.
json without_baselines(json summary) {
  for (const char* name : {"baselines", "verdicts", "protocol", "model_file"}) summary.erase(name);
  for (json& action : summary.at("actions")) action.erase("baselines");
  return summary;
}

json by_program(const Call& call, const std::string& options) {
  std::string clips;
  for (const fs::path& clip : call.test) clips += fmt::format(" '{}'", clip.string());
  const CliResult result = run_cli(
      fmt::format("evaluate --model '{}' --json --quiet --uncertainty-draws {} --test {} {}",
                  call.model.string(), call.uncertainty_draws, clips, options));
  CAPTURE(result.standard_error);
  REQUIRE(result.exit_code == 0);
  // That a calibration pose was dropped is reported, and no more.
  const bool calibrated = std::ranges::any_of(call.test, [](const fs::path& clip) {
    return clip.parent_path().filename() == "calibrated";
  });
  const auto lines = std::ranges::count(result.standard_error, '\n');
  const bool kept = options.find("--keep-first-frame") != std::string::npos;
  CHECK(lines == (calibrated && !kept ? 1 : 0));
  CHECK((lines == 0 ||
         result.standard_error.find("dropped the calibration pose") != std::string::npos));
  return json::parse(result.standard_output);
}

}  // namespace

/// Rows of what makes the tracks of a detector. All are given at once: each row then checks that
/// its own option did something.
std::vector<OptionRow> detector_rows() {
  const TinyPipeline& pipeline = TinyPipeline::instance();
  Call usual;
  usual.model = pipeline.model();
  usual.test = {pipeline.motion() / "walk_s02_01.bvh"};
  usual.like = "openpose";
  Call all = usual;
  all.like = "mediapipe";
  all.camera_known = false;
  all.people = {.height = 0.2, .proportions = 0.2};
  using Cameras = mcdbn::DetectorCameras;
  const std::vector<std::tuple<std::string, double Cameras::*, double>> cameras = {
      {"--detector-elevation-from", &Cameras::elevation_from_deg, 10},
      {"--detector-elevation-to", &Cameras::elevation_to_deg, 60},
      {"--detector-roll", &Cameras::roll_deg, 1},
      {"--detector-fov-from", &Cameras::fov_from_deg, 20},
      {"--detector-fov-to", &Cameras::fov_to_deg, 90},
      {"--detector-distance-from", &Cameras::distance_from_m, 4},
      {"--detector-distance-to", &Cameras::distance_to_m, 30}};
  std::string given =
      "--baselines none --tracks detector --like mediapipe --camera-unknown --person-height 0.2 "
      "--person-proportions 0.2";
  for (const auto& [option, setting, value] : cameras) {
    all.cameras.*setting = value;
    given += fmt::format(" {} {}", option, value);
  }
  const json found = without_baselines(by_program(all, given));
  CHECK(found == without_baselines(by_library(all)));
  const auto row = [=](const std::string& option, const std::function<void(Call&)>& undo) {
    return OptionRow{option, [=] {
                       Call without = all;
                       undo(without);
                       CHECK(by_library(without).at("model") != found.at("model"));
                     }};
  };
  std::vector<OptionRow> rows = {
      {"--tracks",
       [usual] {
         Call exact = usual;
         exact.like.clear();
         const json by_default = without_baselines(by_library(usual));
         CHECK(by_library(exact).at("model") != by_default.at("model"));
         CHECK(without_baselines(by_program(usual, "--baselines none --tracks detector")) ==
               by_default);
       }},
      row("--like", [](Call& call) { call.like = "openpose"; }),
      row("--camera-unknown", [](Call& call) { call.camera_known = true; }),
      row("--person-height", [](Call& call) { call.people.height = mcdbn::OtherBody{}.height; }),
      row("--person-proportions",
          [](Call& call) { call.people.proportions = mcdbn::OtherBody{}.proportions; })};
  for (const auto& [option, setting, value] : cameras)
    rows.push_back(row(
        option, [setting = setting](Call& call) { call.cameras.*setting = Cameras{}.*setting; }));
  return rows;
}

TEST_CASE("evaluate: every option changes what its help describes") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder folder;
  Call all;
  all.model = pipeline.model();
  // Two clips of one action: a pair of real ones, and by the seed as many of the regenerations'.
  all.test = {with_calibration_pose(pipeline.motion() / "walk_s02_01.bvh",
                                    folder / "calibrated/walk_s02_09.bvh"),
              pipeline.motion() / "walk_s01_01.bvh", pipeline.motion() / "walk_s01_02.bvh"};
  all.by_folder = all.keep_first_frame = all.include_training = true;
  all.fit = false;
  all.samples = 2;
  all.temperature = 0.7;
  all.sampling = mcdbn::SamplingRule{2, 3, false, 1.0};
  all.seed = 9;
  all.azimuth_deg = 55;
  all.elevation_deg = 20;
  all.damage = {2, 0.1, 0.3};
  // Everything at once: each row then checks that its own option did something.
  const fs::path report = folder / "report";
  const json summary = by_program(
      all, fmt::format("--actions by-folder --keep-first-frame --include-training --fit none "
                       "--samples 2 --temperature 0.7 --gibbs-steps 2 --mrbm-gibbs-steps 3 "
                       "--seed 9 --camera-azimuth 55 --camera-elevation 20 --track-noise-px 2 "
                       "--track-missing 0.1 --track-hide 0.3 --report '{}'",
                       report.string()));
  const json found = without_baselines(summary);
  CHECK(found == without_baselines(by_library(all)));
  const auto row = [&](const char* option, const std::function<void(Call&)>& undo) {
    return OptionRow{option, [=, &all] {
                       Call without = all;
                       undo(without);
                       const json other = by_library(without);
                       CHECK(found.at("model") != other.at("model"));
                       CHECK(found != without_baselines(other));
                     }};
  };
  const auto refused = [&](const std::string& options, int exit_code) {
    return run_cli(fmt::format("evaluate --quiet --model '{}' --test '{}' {}", all.model.string(),
                               all.test[1].string(), options))
               .exit_code == exit_code;
  };
  std::vector<OptionRow> rows = {
      row("--keep-first-frame", [](Call& call) { call.keep_first_frame = false; }),
      row("--fit", [](Call& call) { call.fit = true; }),
      row("--samples", [](Call& call) { call.samples = 1; }),
      row("--temperature", [](Call& call) { call.temperature = 1; }),
      row("--gibbs-steps", [](Call& call) { call.sampling->gibbs_steps = 0; }),
      row("--mrbm-gibbs-steps", [](Call& call) { call.sampling->mrbm_gibbs_steps = 0; }),
      row("--seed", [](Call& call) { call.seed = 1; }),
      row("--camera-azimuth", [](Call& call) { call.azimuth_deg = 30; }),
      row("--camera-elevation", [](Call& call) { call.elevation_deg = 10; }),
      row("--track-noise-px", [](Call& call) { call.damage.noise_px = 0; }),
      row("--track-missing", [](Call& call) { call.damage.missing_share = 0; }),
      row("--track-hide", [](Call& call) { call.damage.hidden_s = 0; }),
      row("--test", [](Call& call) { call.test.pop_back(); }),
      {"--actions",
       [&] {
         CHECK(found.at("actions").size() == 2);
         CHECK(found.at("actions").at(0).at("name") == "calibrated");
         CHECK(found.at("actions").at(1).at("name") == "motion");
       }},
      {"--include-training",
       [&] {
         CHECK(found.at("training_clips") == 2);
         CHECK(refused("", 3));
       }},
      {"--report",
       [&] {
         CHECK(json::parse(mcdbn::read_text_file(report / "summary.json")) == summary);
         CHECK(fs::file_size(report / "report.html") > 10000);
       }},
      {"--model", [&] { CHECK(summary.at("model_file") == "model.safetensors"); }},
      {"--json", [&] { CHECK(summary.is_object()); }},
      {"--baselines",
       [&] {
         // Two of those that are usual, by name and in the report's order, and one that is not.
         const json some =
             by_program(all, "--baselines twin_gaussian_process,ridge_window --include-training");
         REQUIRE(some.at("baselines").size() == 2);
         CHECK(some.at("baselines").contains("ridge_window"));
         CHECK(some.at("baselines").contains("twin_gaussian_process"));
         CHECK(by_program(all, "--baselines none --include-training").at("baselines").empty());
         CHECK(summary.at("baselines").size() == 5);
         CHECK(refused("--include-training --baselines ridge", 2));
       }},
      {"--uncertainty-draws",
       [&] {
         Call fitted;
         fitted.model = all.model;
         fitted.test = {pipeline.motion() / "walk_s02_01.bvh"};
         fitted.seed = 3;
         fitted.uncertainty_draws = 5;
         const json by_five = without_baselines(by_program(fitted, "--baselines none --seed 3"));
         CHECK(by_five == without_baselines(by_library(fitted)));
         CHECK(by_five.at("model").at("within_90").is_number());
         CHECK(by_five.at("coverage").at("joints").at("all").at("share").is_number());
         fitted.uncertainty_draws = 0;
         CHECK(by_program(fitted, "--baselines none").at("model").at("within_90").is_null());
         CHECK(refused("--include-training --uncertainty-draws -1", 2));
       }},
      {"--joint-map",  // corpus_test.cpp has a model of the humanoid, which takes it
       [&] {
         const fs::path map = folder.write("map.toml", "head = \"Neck\"\n");
         CHECK(refused(fmt::format("--include-training --joint-map '{}'", map.string()), 2));
         CHECK(refused("--include-training --joint-map absent", 3));
       }},
      {"--protocol", [&] { CHECK(refused("--protocol other", 2)); }},
      {"--platform", [&] { CHECK(refused("--platform no-such-name", 4)); }},
      {"--device", [&] { CHECK(refused("--device no-such-name", 4)); }},
      {"--quiet", [] {}}};  // by_program gives it, and the next test case does not
  for (OptionRow& of_detector : detector_rows()) rows.push_back(std::move(of_detector));
  check_options("evaluate", rows);
}

TEST_CASE("evaluate: what holds where an option is not given, and the text for people") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  Call call;
  call.model = pipeline.model();
  call.test = {pipeline.motion() / "walk_s02_01.bvh"};
  const std::string platform = mcdbn::list_devices().at(0).platform_name;
  const CliResult text = run_cli(fmt::format("evaluate --model '{}' --test '{}' --platform '{}'",
                                             call.model.string(), call.test[0].string(), platform));
  REQUIRE(text.exit_code == 0);
  CHECK(text.standard_error.find("%  reading clips") != std::string::npos);
  CHECK(text.standard_output.starts_with("1 clip, 36 frames\n"));
  call.uncertainty_draws = 50;
  const json wanted = by_library(call, views_of_training(call.model));
  const double share = wanted.at("coverage").at("joints").at("all").at("share");
  const std::string held = fmt::format("{:.1f} % ", 100 * share);
  for (const std::string& sentence :
       {" Of 90 % intervals of the joints' places, " + held + "hold the truth",
        "\n90 % intervals that hold the truth: of joints " + held})
    CHECK(text.standard_output.find(sentence) != std::string::npos);
  const json& track = wanted.at("track_from_pose");
  const std::string line = fmt::format(
      "\n2D from 3D: joints {:.1f} px off, relative to the root (the mean track {:.1f} px)\n",
      track.at("track_error_px").get<double>(), track.at("mean_track_error_px").get<double>());
  CHECK(text.standard_output.find(line) != std::string::npos);
  const auto check_row = [&](const std::string& name, const json& scores) {
    const auto figure = [&](const char* of) { return scores.at(of).get<double>(); };
    const std::string row = fmt::format(
        "\n{:<22}{:>10.4f}{:>12.3f}{:>11.1f}{:>14.1f}{:>10.0f}\n", name, figure("pcc_flat"),
        figure("pcc_channel"), figure("mpjpe_mm"), figure("pa_mpjpe_mm"), figure("root_mm"));
    CAPTURE(row);
    CHECK(text.standard_output.find(row) != std::string::npos);
  };
  check_row("model", wanted.at("model"));
  for (const auto& [name, scores] : wanted.at("baselines").items()) check_row(name, scores);
}

TEST_CASE("evaluate --camera-unknown: the text has no root error, and names what was hidden") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const CliResult text = run_cli(fmt::format(
      "evaluate --model '{}' --test '{}' --platform '{}' --camera-unknown --baselines none "
      "--uncertainty-draws 0 --quiet",
      pipeline.model().string(), (pipeline.motion() / "walk_s02_01.bvh").string(),
      mcdbn::list_devices().at(0).platform_name));
  REQUIRE(text.exit_code == 0);
  const std::string& output = text.standard_output;
  const auto row = output.find("\nmodel ");
  REQUIRE(row != std::string::npos);
  CHECK(output.substr(row, output.find('\n', row + 1) - row).ends_with("  -"));
  CHECK(output.find("No method knew the camera") != std::string::npos);
}

TEST_CASE("evaluate: what makes a detector's tracks is refused where tracks are exact") {
  for (const char* option : {"--like mediapipe", "--person-height 0.2", "--person-proportions 0.2",
                             "--detector-roll 1", "--detector-distance-to 30"}) {
    CAPTURE(option);
    const std::string flag = std::string(option).substr(0, std::string(option).find(' '));
    for (const char* tracks : {"", "--tracks exact"}) {
      const CliResult result =
          run_cli(fmt::format("evaluate --model m --test t {} {}", option, tracks));
      CHECK(result.exit_code == 2);
      CHECK(result.standard_error.find(flag + " is for --tracks detector") != std::string::npos);
    }
  }
}

TEST_CASE("evaluate: a training clip is read for the baselines that learn from it alone") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder folder;
  const fs::path clip = folder / "walk_s01_01.bvh", other = folder / "walk_s01_02.bvh",
                 run = folder / "run";
  for (const fs::path& copy : {clip, other})
    fs::copy_file(pipeline.motion() / copy.filename(), copy);
  REQUIRE(train(fmt::format("'{}' '{}'", clip.string(), other.string()), run, kTiny + " --quiet")
              .exit_code == 0);
  const auto exit_code = [&](const char* baselines) {
    return run_cli(fmt::format("evaluate --model '{}' --test '{}' --fit none --uncertainty-draws 0 "
                               "--baselines {}",
                               (run / "model.safetensors").string(),
                               (pipeline.motion() / "walk_s02_01.bvh").string(), baselines))
        .exit_code;
  };
  folder.write("walk_s01_01.bvh", "no motion");
  CHECK(exit_code("none") == 0);
  CHECK(exit_code("ridge_window") == 3);
  fs::remove(clip);
  CHECK(exit_code("none") == 0);
  CHECK(exit_code("ridge_window") == 3);
}

TEST_CASE("evaluate: --gibbs-steps alone draws, at temperature 1") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  Call call;
  call.model = pipeline.model();
  call.test = {pipeline.motion() / "walk_s02_01.bvh"};
  call.fit = false;
  const json drawn = by_program(call, "--fit none --baselines none --gibbs-steps 2");
  CHECK(drawn.at("temperature") == 1.0);
  call.temperature = 1;
  call.sampling = mcdbn::SamplingRule{2, 0, false, 1.0};
  CHECK(without_baselines(drawn) == without_baselines(by_library(call)));
}

TEST_CASE("evaluate --protocol paper: ten samples by the network alone, by folder") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  Call call;
  call.model = pipeline.model();
  call.test = {pipeline.motion() / "walk_s01_02.bvh"};
  const json summary = by_program(call, "--protocol paper");
  CHECK(summary.at("protocol") == "paper");
  call.samples = 10;
  call.temperature = 1;
  call.fit = false;
  call.by_folder = call.include_training = true;
  CHECK(without_baselines(summary) == without_baselines(by_library(call)));
}

TEST_CASE("evaluate: without fine-tuning there were no views, and the MLP learns from none") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  Call call;
  call.model = pipeline.folder("greedy") / "model.safetensors";
  call.test = {pipeline.motion() / "walk_s02_01.bvh"};
  call.fit = false;
  REQUIRE(train(pipeline.training_clips(), call.model.parent_path(),
                kTinyGreedy + " --stages greedy --layers 1 --quiet")
              .exit_code == 0);
  CHECK(by_program(call, "--fit none").at("baselines") ==
        by_library(call, Views{}).at("baselines"));
}

}  // namespace evaluate_options_test
