// A test run on what a detector would see: the same for every method.

#include <doctest/doctest.h>

#include <cmath>
#include <set>

#include "comparison/clip_files.hpp"
#include "comparison/comparison_run.hpp"
#include "comparison/limb_keypoints.hpp"
#include "comparison/report_clips.hpp"
#include "device/every_device.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/camera/side_swaps.hpp"
#include "mcdbn/synthesis/synthesize.hpp"
#include "motion/body_size.hpp"
#include "motion_model/pose_priors.hpp"

namespace detector_run_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr double kFps = 30;

Motion walk(int subject, int clip) {
  SynthesisOptions options;
  options.subject = subject;
  options.clip = clip;
  options.seconds = 1.0;
  options.fps = kFps;
  return synthesize(options);
}

struct Scene : ClipFiles {
  Scene()
      : ClipFiles({{"walk_s01_01.bvh", walk(1, 1)}, {"walk_s02_01.bvh", walk(2, 1)}},
                  {{"walk_s03_01.bvh", walk(3, 1)}, {"walk_s04_01.bvh", walk(4, 1)}}, {}) {}
  TestRunOptions options() const {
    TestRunOptions options;
    options.baselines.clear();
    options.regeneration.run_in = 4;
    options.regeneration.seed = 40;
    options.detector = DetectorViews{limb_keypoints(), detectors().front().noise, {}, {}};
    return options;
  }
};

bool same(const MatrixD& a, const MatrixD& b) {
  return a.rows() == b.rows() &&
         ((a.array() == b.array()) || (a.array().isNaN() && b.array().isNaN())).all();
}

}  // namespace

TEST_CASE("a detector's test run: the clip by another body, from another camera, sides put right") {
  const Scene scene;
  on_every_device([&](Device& device) {
    const TestRunOptions options = scene.options();
    const Model model = scene.model(device);
    const auto results = run_test(model, scene.tests, options);
    REQUIRE(results.size() == 2);
    for (std::size_t i = 0; i < 2; ++i) {
      CAPTURE(i);
      const EncodedClip& truth = results[i].truth;
      AugmentedView want =
          detector_view(load_clip(scene.tests[i], {.fps = kFps}), *options.detector, 40 + i);
      exchange_sides(want.track, find_side_swaps(want.track));
      CHECK(truth.motion.channels == want.motion.channels);
      CHECK(truth.camera.camera_from_world == want.camera.camera_from_world);
      CHECK(same(truth.track.x_px, want.track.x_px));
      CHECK(same(truth.track.confidence, want.track.confidence));
      CHECK(truth.track.joint_names[2] == "left_elbow");
      // The body is not given: the answer has the model's, with lengths that the track shows.
      const Skeleton& answered = results[i].samples.at(0).motion.skeleton;
      const Eigen::Vector3d own = scene.modalities.pose_features.skeleton().joints[3].offset;
      const Eigen::Vector3d offset = answered.joints[3].offset;
      CHECK(offset.cross(own).norm() < 1e-9 * own.squaredNorm());
      const double often = std::exp(2 * TrackFitSettings{}.bone_log_deviation);  // two deviations
      CHECK(offset.norm() > own.norm() / often);
      CHECK(offset.norm() < own.norm() * often);
      CHECK(offset != own);
      CHECK(offset != truth.motion.skeleton.joints[3].offset);
      CHECK(std::isfinite(results[i].samples.at(0).score.limbs.pa_mpjpe_mm));
    }
    CHECK(results[0].truth.camera.camera_from_world != results[1].truth.camera.camera_from_world);
    // What the report shows as the 2D input are the model's joints, some of them never seen.
    const auto clips = report_clips(model, results, false);
    CHECK(clips[0].track_px.array().isNaN().any());
    CHECK(!clips[0].track_px.array().isNaN().all());
  });
}

TEST_CASE("a detector's test run fits a detector's track of an unknown body, as regenerate does") {
  const Scene scene;
  on_every_device([&](Device& device) {
    const TestRunOptions options = scene.options();
    const Model model = scene.model(device);
    bool matters = false;
    for (const ClipResult& result : run_test(model, scene.tests, options)) {
      KnownOfClip known{result.truth.camera, {}};
      known.camera->unit_m = 1.0 / file_units_per_metre(result.truth.motion.skeleton);
      known.found = result.seen.view;
      const PosePrior prior =
          pose_priors(model.network, {result.seen.features}, options.regeneration).front();
      const auto fitted = [&](bool detected) {
        known.detected = detected;
        return fit_to_track(prior, model.modalities, result.seen.joints, known, options.fit)
            .motion.channels;
      };
      CHECK((result.samples.at(0).motion.channels == fitted(true)));
      matters = matters || (fitted(false) != fitted(true));
    }
    CHECK(matters);
  });
}

TEST_CASE("a detector's test run shows every method the same track, whatever else runs") {
  const Scene scene;
  on_every_device([&](Device& device) {
    TestRunOptions options = scene.options();
    const Model model = scene.model(device);
    const auto alone = run_test(model, scene.tests, options);
    options.baselines = {"mean_pose", "nearest_neighbour"};
    const auto together = run_test(model, scene.tests, options);
    for (std::size_t i = 0; i < 2; ++i) {
      CHECK(same(alone[i].truth.track.x_px, together[i].truth.track.x_px));
      CHECK(alone[i].samples.at(0).motion.channels == together[i].samples.at(0).motion.channels);
      const auto& others = together[i].other_answers;
      REQUIRE(others.size() == 2);
      // The mean pose is fitted to that track, too: turned, it is no mean pose any more.
      CHECK(others.at("mean_pose").motion.channels.row(0) !=
            others.at("mean_pose").motion.channels.row(9));
    }
  });
}

TEST_CASE(
    "a detector's test run hides an arm of the detector's track, or says that it shows none") {
  const Scene scene;
  on_every_device([&](Device& device) {
    TestRunOptions options = scene.options();
    const Model model = scene.model(device);
    const auto whole = run_test(model, scene.tests, options);
    options.damage.hidden_s = 10;  // longer than the clips
    const auto damaged = run_test(model, scene.tests, options);
    for (std::size_t i = 0; i < 2; ++i) {
      const Track2d &before = whole[i].truth.track, &after = damaged[i].truth.track;
      std::set<std::string> hidden;
      for (int column = 0; column < before.joint_count(); ++column) {
        const std::string& name = before.joint_names[static_cast<std::size_t>(column)];
        CAPTURE(name);
        REQUIRE((before.confidence.col(column).array() > 0).any());
        if (after.confidence.col(column).isZero())
          hidden.insert(name);
        else
          CHECK(same(before.x_px.col(column), after.x_px.col(column)));
      }
      using Names = std::set<std::string>;
      CHECK((hidden == Names{"left_shoulder", "left_elbow", "left_wrist"} ||
             hidden == Names{"right_shoulder", "right_elbow", "right_wrist"}));
    }
    std::erase_if(options.detector->keypoints, [](const Keypoint& keypoint) {
      return keypoint.name.ends_with("shoulder") || keypoint.name.ends_with("elbow") ||
             keypoint.name.ends_with("wrist");
    });
    CHECK_THROWS_WITH_AS(run_test(model, scene.tests, options),
                         doctest::Contains("walk_s03_01.bvh: the track shows no arm"), InputError);
  });
}

TEST_CASE("a test run whose camera is unknown answers in the assumed camera's axes, turned back") {
  const Scene scene;
  on_every_device([&](Device& device) {
    TestRunOptions options = scene.options();
    const Model model = scene.model(device);
    const auto known = run_test(model, scene.tests, options);
    options.camera_known = false;
    const auto unknown = run_test(model, scene.tests, options);
    for (std::size_t i = 0; i < 2; ++i) {
      const LimbError &a = known[i].samples.at(0).score.limbs,
                      &b = unknown[i].samples.at(0).score.limbs;
      CHECK(same(known[i].truth.track.x_px, unknown[i].truth.track.x_px));
      CHECK(a.mpjpe_mm != b.mpjpe_mm);
      // Without the turn back the heading would be off by up to half a turn.
      CHECK(b.mpjpe_mm < a.mpjpe_mm + 150);
    }
  });
}

TEST_CASE("a test run whose camera is unknown: where the clip stands changes no figure") {
  const Scene scene;
  Motion moved = walk(3, 1);
  moved.channels.col(0).array() += 900;  // more than nine metres
  const auto elsewhere = scene.write("elsewhere.bvh", moved);
  on_every_device([&](Device& device) {
    TestRunOptions options = scene.options();
    options.detector.reset();
    const Model model = scene.model(device);
    CHECK(std::isfinite(run_test(model, {scene.tests[0]}, options)[0].samples.at(0).score.root_mm));
    options.camera_known = false;
    options.baselines = {"mean_pose"};
    const auto results = run_test(model, {scene.tests[0], elsewhere}, options);
    const auto scores = [&](std::size_t clip) {
      return std::vector{results[clip].samples.at(0).score,
                         results[clip].other_answers.at("mean_pose").score};
    };
    for (std::size_t method = 0; method < 2; ++method) {
      const ClipScore here = scores(0)[method], there = scores(1)[method];
      CHECK(std::isnan(here.root_mm));
      CHECK(std::isnan(there.root_mm));
      CHECK(there.error.mpjpe_mm == doctest::Approx(here.error.mpjpe_mm).epsilon(0.02));
    }
  });
}

TEST_CASE("a test run whose camera is unknown: a still node above the hips changes no figure") {
  const Scene scene;
  Motion below = walk(3, 1);
  for (Joint& joint : below.skeleton.joints) ++joint.parent;
  Joint node;
  node.name = "Node";
  below.skeleton.joints.insert(below.skeleton.joints.begin(), node);
  const auto with_node = scene.write("below.bvh", below);
  on_every_device([&](Device& device) {
    TestRunOptions options = scene.options();
    options.detector.reset();
    options.camera_known = false;
    const Model model = scene.model(device);
    const auto results = run_test(model, {scene.tests[0], with_node}, options);
    const LimbError &plain = results[0].samples.at(0).score.limbs,
                    &below_node = results[1].samples.at(0).score.limbs;
    CHECK(below_node.mpjpe_mm == doctest::Approx(plain.mpjpe_mm).epsilon(0.02));
    CHECK(below_node.turned_mpjpe_mm == doctest::Approx(plain.turned_mpjpe_mm).epsilon(0.02));
  });
}

}  // namespace detector_run_test
