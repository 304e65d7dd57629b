#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "mcdbn/motion/bvh.hpp"
#include "mcdbn/motion/camera.hpp"
#include "mcdbn/motion/keypoints.hpp"
#include "mcdbn/text_file.hpp"
#include "motion/scratch_folder.hpp"
#include "run_cli.hpp"

using namespace mcdbn::test;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

constexpr const char* kTiny =
    "--hidden 8 --mrbm-hidden 8 --phases 1 --gaussian-epochs 2 --binary-epochs 2 --mrbm-epochs 2 "
    "--joint-steps 3 --joint-windows 4 --augment-views 2";

std::set<std::string> stages_of(const fs::path& run) {
  std::set<std::string> stages;
  std::istringstream lines(mcdbn::read_text_file(run / "metrics.jsonl"));
  for (std::string line; std::getline(lines, line);) {
    const json metrics = json::parse(line);
    CHECK(metrics.at("loss").is_number());
    stages.insert(metrics.at("stage"));
  }
  return stages;
}

CliResult synthesize(const fs::path& folder) {
  return run_cli(
      fmt::format("synthesize --action walk --clips 4 --subjects 2 --seconds 3 --seed 5 -o '{}'",
                  folder.string()));
}

/// The synthesized clips of one subject, each in quotes.
std::string clips_of(const fs::path& folder, int subject) {
  std::string files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().filename().string().find(fmt::format("_s{:02}_", subject)) !=
        std::string::npos)
      files += fmt::format(" '{}'", entry.path().string());
  }
  REQUIRE(!files.empty());
  return files;
}

CliResult train(const std::string& clips, const fs::path& run, const std::string& options,
                const std::string& environment = "") {
  return run_cli(fmt::format("train {} -o '{}' {}", clips, run.string(), options), environment);
}

/// The whole job at a size that takes seconds, done once for all tests below.
class TinyPipeline {
 public:
  static const TinyPipeline& instance() {
    static const TinyPipeline pipeline;
    return pipeline;
  }
  fs::path motion() const { return folder_ / "motion"; }
  fs::path model() const { return folder_ / "run/model.safetensors"; }
  fs::path folder(const std::string& name) const { return folder_ / name; }
  std::string training_clips() const { return clips_of(motion(), 1); }
  std::string test_clips() const { return clips_of(motion(), 2); }

 private:
  TinyPipeline() {
    REQUIRE(synthesize(motion()).exit_code == 0);
    const CliResult trained = train(training_clips(), folder_ / "run", kTiny);
    CAPTURE(trained.standard_error);
    REQUIRE(trained.exit_code == 0);
    REQUIRE(trained.standard_output.empty());
  }
  ScratchFolder folder_;
};

bool have_device() {
  static const bool have = run_cli("devices").exit_code == 0;
  if (!have) MESSAGE("SKIPPED: no OpenCL device here");
  return have;
}

}  // namespace

TEST_CASE("synthesize writes the same clips for the same seed") {
  const ScratchFolder folder;
  REQUIRE(synthesize(folder / "one").exit_code == 0);
  REQUIRE(synthesize(folder / "two").exit_code == 0);
  int clips = 0;
  for (const auto& entry : fs::directory_iterator(folder / "one")) {
    CHECK(mcdbn::read_text_file(entry.path()) ==
          mcdbn::read_text_file(folder / "two" / entry.path().filename()));
    ++clips;
  }
  CHECK(clips == 4);
  CHECK(
      run_cli(fmt::format("synthesize --action fly -o '{}'", (folder / "no").string())).exit_code ==
      2);
  CHECK(!fs::exists(folder / "no"));
}

TEST_CASE("train writes a run folder") {
  if (!have_device()) return;
  const fs::path run = TinyPipeline::instance().folder("run");
  CHECK(fs::exists(run / "model.safetensors"));
  CHECK(fs::exists(run / "config.toml"));
  CHECK(stages_of(run) == std::set<std::string>{"joint"});
}

TEST_CASE("train --stages leaves stages out") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const auto stages = [&](const std::string& options) {
    const fs::path run = pipeline.folder("stages");
    REQUIRE(train(pipeline.training_clips(), run, std::string(kTiny) + " --quiet " + options)
                .exit_code == 0);
    return stages_of(run);
  };
  CHECK(stages("--stages greedy") ==
        std::set<std::string>{"pose.0", "pose.1", "track.0", "track.1", "mrbm"});
  CHECK(stages("--stages both") == std::set<std::string>{"pose.0", "track.0", "mrbm", "joint"});
  CHECK(stages("--stages both --layers 2") ==
        std::set<std::string>{"pose.0", "pose.1", "track.0", "track.1", "mrbm", "joint"});
}

TEST_CASE("the same seed trains the same model, from the recorded config too") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const std::string model = mcdbn::read_text_file(pipeline.model());
  const fs::path config = pipeline.folder("run") / "config.toml";

  REQUIRE(train(pipeline.training_clips(), pipeline.folder("again"),
                fmt::format("--quiet --config '{}'", config.string()))
              .exit_code == 0);
  CHECK(mcdbn::read_text_file(pipeline.folder("again") / "model.safetensors") == model);
  REQUIRE(train(pipeline.training_clips(), pipeline.folder("other"),
                std::string(kTiny) + " --quiet --seed 2")
              .exit_code == 0);
  CHECK(mcdbn::read_text_file(pipeline.folder("other") / "model.safetensors") != model);
}

TEST_CASE("a setting that is on is switched off by --no-NAME") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  REQUIRE(train(pipeline.training_clips(), pipeline.folder("unmirrored"),
                std::string(kTiny) + " --quiet --no-augment-mirror")
              .exit_code == 0);
  const auto recorded = [&](const char* run) {
    return mcdbn::read_text_file(pipeline.folder(run) / "config.toml");
  };
  CHECK(recorded("run").find("mirror = true") != std::string::npos);
  CHECK(recorded("unmirrored").find("mirror = false") != std::string::npos);
}

TEST_CASE("regenerate gives every input frame an output frame on the model's skeleton") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  std::string clip = pipeline.test_clips();
  clip = clip.substr(2, clip.find('\'', 2) - 2);
  const fs::path track = pipeline.folder("track.csv");
  const fs::path output = pipeline.folder("out.bvh");
  REQUIRE(run_cli(fmt::format("project '{}' -o '{}'", clip, track.string())).exit_code == 0);
  const std::string command =
      fmt::format("regenerate --model '{}' --input '{}' -o '{}'", pipeline.model().string(),
                  track.string(), output.string());
  const CliResult result = run_cli(command);
  CAPTURE(result.standard_error);
  REQUIRE(result.exit_code == 0);
  CHECK(result.standard_output.empty());

  const mcdbn::Motion truth = mcdbn::read_bvh(clip);
  const mcdbn::Motion regenerated = mcdbn::read_bvh(output);
  CHECK(regenerated.frames() == mcdbn::read_track_csv(track).frames());
  REQUIRE(regenerated.skeleton.joint_count() == truth.skeleton.joint_count());
  for (int joint = 0; joint < truth.skeleton.joint_count(); ++joint)
    CHECK(regenerated.skeleton.joints[joint].name == truth.skeleton.joints[joint].name);
  const auto angles_deg = regenerated.channels.rightCols(regenerated.skeleton.channel_count() - 6);
  const mcdbn::MatrixD steps_deg = angles_deg.bottomRows(regenerated.frames() - 1) -
                                   angles_deg.topRows(regenerated.frames() - 1);
  CHECK(steps_deg.cwiseAbs().maxCoeff() <= 180.0);

  const std::string sampled = command + " --samples 2 --temperature 1 --seed 9";
  REQUIRE(run_cli(sampled).exit_code == 0);
  const std::string first = mcdbn::read_text_file(pipeline.folder("out_01.bvh"));
  CHECK(first != mcdbn::read_text_file(pipeline.folder("out_02.bvh")));
  REQUIRE(run_cli(sampled).exit_code == 0);
  CHECK(first == mcdbn::read_text_file(pipeline.folder("out_01.bvh")));
  REQUIRE(run_cli(sampled + " --mrbm-gibbs-steps 2").exit_code == 0);
  CHECK(first != mcdbn::read_text_file(pipeline.folder("out_01.bvh")));
}

TEST_CASE("evaluate prints one object, and refuses clips that were trained on") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const std::string evaluate =
      fmt::format("evaluate --model '{}' --json --test ", pipeline.model().string());
  const CliResult result = run_cli(evaluate + pipeline.test_clips());
  CAPTURE(result.standard_error);
  REQUIRE(result.exit_code == 0);
  const json summary = json::parse(result.standard_output);
  CHECK(summary.at("clips") == 2);
  CHECK(summary.at("frames") == 180);
  const auto check_scores = [](const json& scores) {
    CHECK(std::abs(scores.at("pcc_flat").get<double>()) <= 1.0);
    CHECK(std::abs(scores.at("pcc_channel").get<double>()) <= 1.0);
    CHECK(scores.at("mpjpe_mm").get<double>() > 0.0);
  };
  check_scores(summary.at("model"));
  for (const char* baseline :
       {"mean_pose", "hold_last_frame", "nearest_neighbour", "ridge_window", "mlp_window"}) {
    CAPTURE(baseline);
    check_scores(summary.at("baselines").at(baseline));
  }

  const CliResult refused = run_cli(evaluate + pipeline.training_clips());
  CHECK(refused.exit_code == 3);
  CHECK(refused.standard_output.empty());
  CHECK(refused.standard_error.find("--include-training") != std::string::npos);
  CHECK(run_cli(evaluate + pipeline.training_clips() + " --include-training").exit_code == 0);
}

TEST_CASE("regenerate --fit none leaves the network's answer, track is the default") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const std::string clip = pipeline.test_clips().substr(1, pipeline.test_clips().find("' '"));
  const fs::path track = pipeline.folder("fit_track.csv"), camera = pipeline.folder("fit.yaml");
  REQUIRE(run_cli(fmt::format("project {} -o '{}' --write-camera '{}'", clip, track.string(),
                              camera.string()))
              .exit_code == 0);
  const mcdbn::Track2d wanted = mcdbn::read_track_csv(track);
  const auto regenerate = [&](const std::string& options) {
    const fs::path output = pipeline.folder("fit.bvh");
    REQUIRE(run_cli(fmt::format("regenerate --model '{}' --input '{}' -o '{}' --camera '{}' {}",
                                pipeline.model().string(), track.string(), output.string(),
                                camera.string(), options))
                .exit_code == 0);
    return mcdbn::read_bvh(output);
  };
  const auto miss_px = [&](const mcdbn::Motion& motion) {
    CHECK(motion.frames() == wanted.frames());
    const mcdbn::Track2d seen = mcdbn::project_motion(motion, mcdbn::read_camera(camera));
    return (seen.x_px - wanted.x_px).norm() + (seen.y_px - wanted.y_px).norm();
  };
  const mcdbn::Motion fitted = regenerate("");
  CHECK(miss_px(fitted) < miss_px(regenerate("--fit none")));
  CHECK(fitted.channels == regenerate("--fit track").channels);
  CHECK(miss_px(regenerate("--skeleton " + clip)) < miss_px(fitted));
  CHECK(run_cli("regenerate --model m --input t.csv -o o.bvh --fit some").exit_code == 2);
}

TEST_CASE("evaluate fits every method, or none, and damages tracks by the seed") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const auto evaluate = [&](const std::string& options) {
    const CliResult result =
        run_cli(fmt::format("evaluate --model '{}' --json --quiet --test {} {}",
                            pipeline.model().string(), pipeline.test_clips(), options));
    CAPTURE(result.standard_error);
    REQUIRE(result.exit_code == 0);
    return json::parse(result.standard_output);
  };
  const auto mpjpe_mm = [](const json& scores) { return scores.at("mpjpe_mm").get<double>(); };
  const json fitted = evaluate(""), plain = evaluate("--fit none");
  CHECK(fitted.at("fit") == "track");
  CHECK(plain.at("fit") == "none");
  CHECK(mpjpe_mm(fitted.at("model")) < mpjpe_mm(plain.at("model")));
  for (const auto& [name, scores] : fitted.at("baselines").items()) {
    CAPTURE(name);
    CHECK(mpjpe_mm(scores) < mpjpe_mm(plain.at("baselines").at(name)));
  }
  const std::string damage = "--fit none --track-noise-px 5 --track-missing 0.2 --track-hide 0.5";
  const json damaged = evaluate(damage);
  CHECK(damaged.at("track_damage") ==
        json{{"noise_px", 5.0}, {"missing_share", 0.2}, {"hidden_s", 0.5}});
  CHECK(mpjpe_mm(damaged.at("baselines").at("ridge_window")) >
        mpjpe_mm(plain.at("baselines").at("ridge_window")));
  CHECK(evaluate(damage).at("model") == damaged.at("model"));
  CHECK(evaluate(damage + " --seed 2").at("baselines").at("ridge_window") !=
        damaged.at("baselines").at("ridge_window"));
  for (const char* wrong : {"--track-missing 1.5", "--track-hide -1", "--track-noise-px -1"})
    CHECK(run_cli(fmt::format("evaluate --model m --test t {}", wrong)).exit_code == 2);
}

TEST_CASE("evaluate --report writes the tables, by action, training clips marked") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const fs::path report = pipeline.folder("report");
  const std::string evaluate =
      fmt::format("evaluate --model '{}' --quiet --report '{}' --json --test ",
                  pipeline.model().string(), report.string());
  const CliResult result =
      run_cli(evaluate + pipeline.test_clips() +
              " --samples 3 --temperature 0.5 --mrbm-gibbs-steps 2 --actions by-folder");
  CAPTURE(result.standard_error);
  REQUIRE(result.exit_code == 0);
  const json summary = json::parse(result.standard_output);
  CHECK(summary == json::parse(mcdbn::read_text_file(report / "summary.json")));
  CHECK(summary.at("training_clips") == 0);
  CHECK(summary.at("samples") == 3);
  CHECK(summary.at("model_mean_field").at("mpjpe_mm").is_number());
  const json& action = summary.at("actions").at(0);
  CHECK(action.at("name") == "motion");
  CHECK(action.at("pcc_flat").at("count") == 6);
  CHECK(action.at("pairwise_real").at("count") == 1);
  CHECK(action.at("pairwise_regenerated").at("count") == 15);
  CHECK(fs::exists(report / "report.html"));
  CHECK(count_lines(mcdbn::read_text_file(report / "table_3.csv")) == 3);
  CHECK(count_lines(mcdbn::read_text_file(report / "table_7.csv")) == 2);

  // The paper's protocol: every clip, ten times; what was said stays.
  const CliResult paper = run_cli(evaluate + pipeline.test_clips() + pipeline.training_clips() +
                                  " --protocol paper --samples 2");
  CAPTURE(paper.standard_error);
  REQUIRE(paper.exit_code == 0);
  const json all = json::parse(paper.standard_output);
  CHECK(all.at("clips") == 4);
  CHECK(all.at("samples") == 2);
  CHECK(all.at("temperature") == 1.0);
  CHECK(all.at("fit") == "none");
  CHECK(all.at("training_clips") == 2);
  CHECK(mcdbn::read_text_file(report / "table_3.csv").find("motion,2,pcc_flat,8,") !=
        std::string::npos);
}

TEST_CASE("Python's safetensors opens a model file") {
  if (!have_device()) return;
  const fs::path python = MCDBN_PYTHON;
  if (!fs::exists(python)) {
    MESSAGE("SKIPPED Python's safetensors: scripts/install_dependencies --test installs it");
    return;
  }
  const std::string script = fmt::format(
      "from safetensors.numpy import load_file\n"
      "import numpy\n"
      "tensors = load_file('{}')\n"
      "assert tensors and all(t.dtype == numpy.float32 and numpy.isfinite(t).all()\n"
      "                       for t in tensors.values())\n"
      "print(sum(t.size for t in tensors.values()))\n",
      TinyPipeline::instance().model().string());
  const ScratchFolder folder;
  const fs::path file = folder.write("open_model.py", script);
  const CliResult result = run_program(python, fmt::format("'{}'", file.string()));
  CAPTURE(result.standard_error);
  REQUIRE(result.exit_code == 0);
  CHECK(std::stol(result.standard_output) > 0);
}

TEST_CASE("the paper's own settings trip the divergence guard, which says what to lower") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const fs::path run = pipeline.folder("paper");
  const CliResult result = train(pipeline.training_clips(), run, "--preset paper --quiet");
  CHECK(result.exit_code == 1);
  CHECK(result.standard_error.find("lower") != std::string::npos);
  CHECK(!fs::exists(run / "model.safetensors"));
}

TEST_CASE("an unknown setting is exit code 2 and names its line") {
  const ScratchFolder folder;
  const fs::path config = folder.write("bad.toml", "order = 3\nhiden = 20\n");
  const CliResult result =
      train("absent.bvh", folder / "run", fmt::format("--config '{}'", config.string()));
  CHECK(result.exit_code == 2);
  CHECK(result.standard_error.find(config.string() + ":2: ") != std::string::npos);
  CHECK(!fs::exists(folder / "run"));
}

TEST_CASE("a platform or device that is not there is exit code 4 with the list") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const fs::path run = pipeline.folder("nowhere");
  const std::string name = json::parse(run_cli("devices --json").standard_output)
                               .at("devices")
                               .at(0)
                               .at("name")
                               .get<std::string>();
  for (const CliResult& result :
       {train(pipeline.training_clips(), run, "--platform no-such-platform"),
        train(pipeline.training_clips(), run, "", "MCDBN_DEVICE=no-such-device")}) {
    CHECK(result.exit_code == 4);
    CHECK(result.standard_error.find(name) != std::string::npos);
  }
  CHECK(!fs::exists(run));
}

TEST_CASE("an interrupt is exit code 130 and leaves no model") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const fs::path run = pipeline.folder("interrupted");
  const CliResult result = train(pipeline.training_clips(), run, "--joint-steps 1000000",
                                 "timeout --preserve-status --signal=INT 5");
  CHECK(result.exit_code == 130);
  CHECK(!fs::exists(run / "model.safetensors"));
}
