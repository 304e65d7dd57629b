// How sure a test run's answers are, and how many of their intervals hold the truth.

#include <doctest/doctest.h>

#include <cmath>
#include <set>
#include <string>

#include "comparison/clip_files.hpp"
#include "comparison/comparison_run.hpp"
#include "comparison/report_clips.hpp"
#include "device/every_device.hpp"
#include "motion/body_size.hpp"
#include "motion/joint_uncertainty.hpp"
#include "motion/turned_motion.hpp"
#include "motion_model/pose_priors.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

struct Scene : ClipFiles {
  Scene()
      : ClipFiles({{"08_01.bvh", paced_clip(14, 1.0)}},
                  {{"09_01.bvh", paced_clip(12, 0.8)}, {"10_01.bvh", paced_clip(17, 1.1)}},
                  {35, 12, std::nullopt, 45, 1920, 1080}) {}

  TestRunOptions options() const {
    TestRunOptions options;
    options.camera = model_view;
    options.baselines.clear();
    options.uncertainty_draws = {6, 40};
    return options;
  }
};

/// The fit once more, with that seed.
FittedClip fit_of(const Model& model, const ClipResult& result, const TestRunOptions& options,
                  std::uint64_t seed) {
  KnownOfClip known;
  known.skeleton = result.truth.motion.skeleton;
  known.found = result.seen.view;
  if (options.camera_known) {
    known.camera = result.truth.camera;
    known.camera->unit_m = 1.0 / file_units_per_metre(result.truth.motion.skeleton);
  }
  return fit_to_track(pose_prior(model.network, result.seen.features), model.modalities,
                      result.seen.joints, known, options.fit, {6, seed});
}

/// Joint by joint, frame by frame, axis by axis.
double share_by_hand(const ClipResult& result, const ScoredAnswer& answer) {
  const Skeleton& skeleton = answer.motion.skeleton;
  const MatrixD truth = joint_positions(result.truth.motion),
                other = joint_positions(answer.motion);
  const double mm = 1000 / file_units_per_metre(skeleton);
  int held = 0, all = 0;
  for (int joint = 0; joint < skeleton.joint_count(); ++joint) {
    const Joint& judged = skeleton.joints[static_cast<std::size_t>(joint)];
    // A joint that stands where its parent does is not judged.
    if (judged.name == "Hips" || judged.offset.norm() == 0) continue;
    for (Eigen::Index t = 0; t < truth.rows(); ++t)
      for (int axis = 0; axis < 3; ++axis) {
        const auto from_hips = [&](const MatrixD& places) {
          return mm * (places(t, 3 * joint + axis) - places(t, 3 * skeleton.find("Hips") + axis));
        };
        const double off = std::abs(from_hips(truth) - from_hips(other));
        held += off <= 1.6448536 * answer.deviation_mm(t, 3 * joint + axis) ? 1 : 0;
        ++all;
      }
  }
  return static_cast<double>(held) / all;
}

double largest(const MatrixD& difference) {
  return difference.cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("a test run draws of each clip by its own seed, and counts the intervals that hold") {
  const Scene scene;
  on_every_device([&](Device& device) {
    const Model model = scene.model(device);
    const TestRunOptions options = scene.options();
    const auto results = run_test(model, scene.tests, options);
    REQUIRE(results.size() == 2);
    for (std::size_t i = 0; i < 2; ++i) {
      CAPTURE(i);
      const ScoredAnswer& answer = results[i].samples.at(0);
      const Skeleton& skeleton = answer.motion.skeleton;
      const FittedClip want = fit_of(model, results[i], options, 40 + i);
      const MatrixD deviation_mm =
          1000 / file_units_per_metre(skeleton) *
          joint_uncertainty(want.motion, want.draws, skeleton.find("Hips"));
      REQUIRE(answer.deviation_mm.rows() == answer.motion.frames());
      CHECK(largest(answer.deviation_mm - deviation_mm) < 1e-9 * largest(deviation_mm));
      CHECK(answer.score.within_90 == doctest::Approx(share_by_hand(results[i], answer)));
      CHECK(results[i].joints.overall().share() == doctest::Approx(answer.score.within_90));
      CHECK(answer.score.within_90 > 0);
      CHECK(answer.score.within_90 < 1);
    }
  });
}

TEST_CASE("a test run draws of the single answer alone, and of none without a fit or draws") {
  const Scene scene;
  on_every_device([&](Device& device) {
    const Model model = scene.model(device);
    TestRunOptions options = scene.options();
    options.baselines = {"mean_pose"};
    options.regeneration.samples = 2;
    options.regeneration.temperature = 0.5;
    const auto drawn = run_test(model, scene.tests, options);
    for (const ScoredAnswer& sample : drawn[1].samples) {
      CHECK(std::isnan(sample.score.within_90));
      CHECK(sample.deviation_mm.size() == 0);
    }
    CHECK(std::isnan(drawn[1].other_answers.at("mean_pose").score.within_90));
    const MatrixD deviation_mm = drawn[1].other_answers.at(kMeanField).deviation_mm;
    CHECK(std::isfinite(drawn[1].other_answers.at(kMeanField).score.within_90));
    options.regeneration = {};
    const auto alone = run_test(model, scene.tests, options);
    CHECK(alone[1].samples.at(0).deviation_mm == deviation_mm);  // whatever else is drawn

    options.fit.reset();  // then the uncertainty is the prior's
    CHECK(std::isfinite(run_test(model, scene.tests, options)[0].samples.at(0).score.within_90));
    options = scene.options();
    options.uncertainty_draws = {};
    CHECK(std::isnan(run_test(model, scene.tests, options)[0].samples.at(0).score.within_90));
  });
}

TEST_CASE("a test run whose camera is unknown turns what it draws as it turns its answer") {
  Scene scene;
  on_every_device([&](Device& device) {
    for (const bool level_view : {false, true}) {
      CAPTURE(level_view);
      scene.modalities.level_view = level_view;
      const Model model = scene.model(device);
      TestRunOptions options = scene.options();
      options.camera.azimuth_deg = 120;
      options.camera_known = false;
      const ClipResult result = run_test(model, scene.tests, options)[0];
      // Of a level view how the camera stands is found, and the last fit starts from there.
      CHECK(result.seen.view.pitch_deg.has_value() == level_view);
      const ScoredAnswer& answer = result.samples.at(0);
      FittedClip want = fit_of(model, result, options, 40);
      const Eigen::Matrix3d turn =
          result.truth.camera.camera_from_world.transpose() * want.camera.camera_from_world;
      for (Motion& draw : want.draws) draw = turned_motion(std::move(draw), turn);
      const Motion turned = turned_motion(want.motion, turn);
      const MatrixD deviation_mm =
          1000 / file_units_per_metre(turned.skeleton) *
          joint_uncertainty(turned, want.draws, turned.skeleton.find("Hips"));
      CHECK(largest(answer.deviation_mm - deviation_mm) < 1e-9 * largest(deviation_mm));
    }
  });
}

TEST_CASE("a test run in several goes draws of each clip by its own seed") {
  const Scene scene;
  on_every_device([&](Device& device) {
    const Model model = scene.model(device);
    TestRunOptions options = scene.options();
    options.fit.reset();
    options.regeneration.samples = 33;  // 64 sequences at once: a clip at a time
    for (const double temperature : {0.0, 1.0}) {
      CAPTURE(temperature);
      options.regeneration.temperature = temperature;
      const auto results = run_test(model, scene.tests, options);
      REQUIRE(results.size() == 2);
      for (std::size_t i = 0; i < 2; ++i) {
        CAPTURE(i);
        const ScoredAnswer& single =
            temperature > 0 ? results[i].other_answers.at(kMeanField) : results[i].samples.at(0);
        const FittedClip want = fit_of(model, results[i], options, 40 + i);
        const Skeleton& skeleton = want.motion.skeleton;
        const MatrixD deviation_mm =
            1000 / file_units_per_metre(skeleton) *
            joint_uncertainty(want.motion, want.draws, skeleton.find("Hips"));
        CHECK(largest(single.deviation_mm - deviation_mm) < 1e-4 * largest(deviation_mm));
      }
    }
  });
}

TEST_CASE("a test run counts the intervals of the network's channels, if it has deviations") {
  const Scene scene;
  on_every_device([&](Device& device) {
    Model model = scene.model(device);
    TestRunOptions options = scene.options();
    options.fit.reset();
    const Eigen::Index channels = scene.modalities.pose_scale.output_dimension();
    // The same in all frames, from channel to channel more.
    const RowVectorD deviation = RowVectorD::LinSpaced(channels, 0.4, 1.2);
    const Eigen::Index code =
        coded_answers(model.network, {run_test(model, scene.tests, options)[0].seen.features})
            .front()
            .code.cols();
    model.network.deviation = AnswerDeviation{MatrixF::Zero(code, channels),
                                              deviation.array().log().matrix().cast<float>()};
    std::set<std::string> names;
    for (const int column : scene.modalities.pose_scale.kept_columns())
      names.insert(
          scene.modalities.pose_features.feature_names()[static_cast<std::size_t>(column)]);
    for (const ClipResult& result : run_test(model, scene.tests, options)) {
      const MatrixF mean = regenerate(model.network, {result.seen.features}).front();
      const MatrixD off = (result.truth.pose_features - mean).cast<double>();
      int held = 0;
      for (Eigen::Index t = 0; t < off.rows(); ++t)
        for (Eigen::Index k = 0; k < channels; ++k)
          held += std::abs(off(t, k)) <= 1.6448536 * deviation[k] ? 1 : 0;
      const Coverage::Share all = result.channels.overall();
      CHECK(all.all == off.size());
      CHECK(all.held == held);
      CHECK(held > 0);
      CHECK(held < off.size());
      CHECK(all.mean_deviation() == doctest::Approx(0.8));
      std::set<std::string> counted;
      for (const auto& [name, share] : result.channels.by_name()) counted.insert(name);
      CHECK(counted == names);
    }
    options.camera_known = false;
    for (const ClipResult& result : run_test(model, scene.tests, options)) {
      CHECK(result.channels.empty());  // they are along the axes of another camera
      CHECK_FALSE(result.joints.empty());
    }
  });
}

TEST_CASE("a report is given the single answer's uncertainty, joint by joint") {
  const Scene scene;
  on_every_device([&](Device& device) {
    const Model model = scene.model(device);
    TestRunOptions options = scene.options();
    options.baselines = {"mean_pose"};
    const auto results = run_test(model, scene.tests, options);
    const ReportClip clip = report_clips(model, results, false)[1];
    CHECK(clip.others.at("mean_pose").deviation_mm.size() == 0);
    const MatrixD& shown = clip.samples.at(0).deviation_mm;
    REQUIRE(shown.cols() == 3 * clip.joints);
    CHECK(shown.leftCols<3>().isZero());
    const ScoredAnswer& answer = results[1].samples.at(0);
    for (int joint = 1; joint < clip.joints; ++joint) {
      const auto& name = clip.point_names[static_cast<std::size_t>(joint)];
      const int column = 3 * answer.motion.skeleton.find(name);
      CHECK(shown.middleCols<3>(3 * joint) == answer.deviation_mm.middleCols<3>(column));
    }
  });
}
