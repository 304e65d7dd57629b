#include <doctest/doctest.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/capture_bound.hpp"
#include "base/text_file.hpp"
#include "mcdbn/camera/camera.hpp"
#include "mcdbn/camera/track.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "mcdbn/formats/camera_file.hpp"
#include "mcdbn/formats/track_csv.hpp"
#include "tiny_pipeline.hpp"

using namespace mcdbn::test;
using nlohmann::json;
namespace fs = std::filesystem;

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
  CHECK(summary.at("frames") == 72);
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

  const json& track = summary.at("track_from_pose");
  CHECK(track.at("track_error_px").get<double>() > 0.0);
  double mean = 0;
  for (const json& clip : summary.at("per_clip"))
    mean += clip.at("track_from_pose").at("track_error_px").get<double>() / 2;
  CHECK(track.at("track_error_px").get<double>() == doctest::Approx(mean));

  const CliResult refused = run_cli(evaluate + pipeline.training_clips());
  CHECK(refused.exit_code == 3);
  CHECK(refused.standard_output.empty());
  CHECK(refused.standard_error.find("--include-training") != std::string::npos);
  CHECK(run_cli(evaluate + pipeline.training_clips() + " --include-training --baselines none")
            .exit_code == 0);
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
    const mcdbn::Track2d seen = mcdbn::project_motion(
        motion, mcdbn::in_file_units(mcdbn::read_camera(camera), motion.skeleton));
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
    CAPTURE_BOUND(name);
    CHECK(mpjpe_mm(scores) < mpjpe_mm(plain.at("baselines").at(name)));
  }
  const std::string damage =
      "--fit none --baselines ridge_window --track-noise-px 5 --track-missing 0.2 --track-hide 0.5";
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
  CHECK(count_lines(mcdbn::read_text_file(report / "tracks.csv")) == 3);

  // The paper's protocol: every clip, ten times; what was given stays.
  const CliResult paper = run_cli(evaluate + pipeline.test_clips() + pipeline.training_clips() +
                                  " --protocol paper --samples 2 --baselines none");
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
