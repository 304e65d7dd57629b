// The door to the fit, with priors of the test's own: what a mean and a deviation do to the answer.

#include "mcdbn/fitting/track_fit.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "features/clip_modalities.hpp"
#include "fitting/two_second_walk.hpp"
#include "mcdbn/base/errors.hpp"

namespace track_fit_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr int kFrames = 60;
/// A prior is believed to a tenth of a degree at the surest, of the 20 by which it is wrong.
constexpr float kSurest = 0.1F / 20;

/// A walk, its exact track, and a prior whose mean holds both forearms by 20 degrees elsewhere.
struct Scene {
  Motion truth = short_walk();
  Modalities modalities = modalities_of({truth}, {});
  KnownOfClip known{place_camera(truth, {}), truth.skeleton};
  Track2d track = project_motion(truth, *known.camera);
  MatrixF right = modalities.encode_pose(truth, known.camera->camera_from_world);
  PosePrior prior = of_spread_one(with_wrong_forearms());

  /// As far off as the clip's own features stray.
  static PosePrior of_spread_one(MatrixF mean) {
    MatrixF deviation = MatrixF::Ones(mean.rows(), mean.cols());
    return {std::move(mean), std::move(deviation)};
  }
  static Motion short_walk() {
    Motion walk = test::two_second_walk();
    walk.channels.conservativeResize(kFrames, Eigen::NoChange);
    return walk;
  }

  /// Standardized columns of a joint's orientation.
  std::vector<Eigen::Index> columns_of(const char* name) const {
    const auto& joints = modalities.pose_features.joints();
    const int joint = modalities.pose_features.skeleton().find(name);
    const auto turn = std::find(joints.begin(), joints.end(), joint) - joints.begin();
    std::vector<Eigen::Index> columns;
    const auto& kept = modalities.pose_scale.kept_columns();
    for (std::size_t k = 0; k < kept.size(); ++k)
      if (kept[k] / PoseFeatures::kBlock == turn) columns.push_back(static_cast<Eigen::Index>(k));
    REQUIRE(!columns.empty());
    return columns;
  }

  MatrixF with_wrong_forearms() const {
    Motion wrong = truth;
    for (const char* name : {"LeftForeArm", "RightForeArm"}) {
      const int first = truth.skeleton.first_channel(truth.skeleton.find(name));
      wrong.channels.middleCols(first, 3).array() += 20;
    }
    return modalities.encode_pose(wrong, known.camera->camera_from_world);
  }

  /// Which trust any prior by its own deviations.
  static TrackFitSettings believing() {
    TrackFitSettings settings;
    settings.orientation_deviation_deg = 0.1;
    return settings;
  }
  FittedClip fit(const std::optional<TrackFitSettings>& settings = believing()) const {
    return fit_to_track(prior, modalities, track, known, settings);
  }
  /// RMS by which a joint's standardized orientation is off `from` in some frames.
  float off(const Motion& motion, const MatrixF& from, const char* joint, int first = 0,
            int frames = kFrames) const {
    const MatrixF got = modalities.encode_pose(motion, known.camera->camera_from_world);
    float squares = 0;
    const auto columns = columns_of(joint);
    for (const Eigen::Index column : columns)
      squares += (got - from).col(column).segment(first, frames).squaredNorm();
    return std::sqrt(squares / static_cast<float>(frames * columns.size()));
  }
  /// By which the prior's mean is.
  float wrong(const char* joint) const { return off(truth, prior.mean, joint); }
};

}  // namespace

TEST_CASE("fit to track: a mean that is right stays, whatever its deviation") {
  Scene scene;
  for (const float deviation : {0.0F, 0.3F, 1.0F, 3.0F}) {
    CAPTURE(deviation);
    scene.prior = {scene.right, MatrixF::Constant(kFrames, scene.right.cols(), deviation)};
    const FittedClip fitted = scene.fit();
    const MatrixD off = joint_positions(fitted.motion) - joint_positions(scene.truth);
    CHECK(off.cwiseAbs().maxCoeff() < 0.2);  // cm; the exact track is taken to be off by 0.25 px
    CHECK(fitted.motion.fps() == doctest::Approx(scene.modalities.fps));
  }
}

TEST_CASE("fit to track: the surer the prior, the nearer the answer to its mean") {
  Scene scene;
  const auto hand_off_cm = [&](const Motion& motion) {
    return (path_of(motion, "LeftHand") - path_of(scene.truth, "LeftHand")).norm() /
           std::sqrt(kFrames);
  };
  const double wrong_cm = hand_off_cm(scene.fit(std::nullopt).motion);
  REQUIRE(wrong_cm > 5);
  float before = 0;
  for (const float deviation : {0.0F, 0.02F, 0.03F, 0.06F}) {
    CAPTURE(deviation);
    scene.prior.deviation.setConstant(deviation);
    const Motion got = scene.fit().motion;
    const float moved = scene.off(got, scene.prior.mean, "LeftForeArm");
    if (deviation == 0.0F)
      CHECK(moved < kSurest * scene.wrong("LeftForeArm"));
    else
      CHECK(moved > 1.1F * before);
    before = moved;
  }
  CHECK(hand_off_cm(scene.fit().motion) < 0.3 * wrong_cm);
}

TEST_CASE("fit to track: a prior that is surer than usual is believed as a usual one") {
  Scene scene;
  scene.prior.deviation.setZero();
  const TrackFitSettings usual;
  CHECK(scene.off(scene.fit(usual).motion, scene.prior.mean, "LeftForeArm") >
        0.3F * scene.wrong("LeftForeArm"));
}

TEST_CASE("fit to track: a prior that is surer of the velocity than usual is believed as usual") {
  Scene scene;
  scene.prior.mean = scene.right;
  scene.prior.deviation.setZero();
  const auto& kept = scene.modalities.pose_scale.kept_columns();
  const int velocity = scene.modalities.pose_features.velocity_feature();
  for (std::size_t k = 0; k < kept.size(); ++k)
    if (kept[k] >= velocity)
      for (int t = 0; t < kFrames; ++t)
        scene.prior.mean(t, static_cast<Eigen::Index>(k)) += static_cast<float>(std::sin(0.2 * t));
  const auto off_cm = [&](double least_m_s2) {
    TrackFitSettings settings;
    settings.root_m_s2 = least_m_s2;
    const MatrixD off = path_of(scene.fit(settings).motion, "Hips") - path_of(scene.truth, "Hips");
    return off.norm() / std::sqrt(kFrames);
  };
  CHECK(off_cm(TrackFitSettings{}.root_m_s2) < 0.5 * off_cm(1e-3));
}

TEST_CASE("fit to track: each joint moves as far as its own features' deviation lets it") {
  Scene scene;
  for (const Eigen::Index column : scene.columns_of("LeftForeArm"))
    scene.prior.deviation.col(column).setZero();
  const Motion got = scene.fit().motion;
  CHECK(scene.off(got, scene.prior.mean, "LeftForeArm") < kSurest * scene.wrong("LeftForeArm"));
  CHECK(scene.off(got, scene.prior.mean, "RightForeArm") > 0.2F);
}

TEST_CASE("fit to track: each frame moves as far as its own deviation lets it") {
  Scene scene;
  scene.prior.deviation.topRows(kFrames / 2).setZero();
  const Motion got = scene.fit().motion;
  // Turns are smoothed over some frames, so not up to the border.
  constexpr int kAway = kFrames / 2 - 8;
  const float held = scene.off(got, scene.prior.mean, "LeftForeArm", 0, kAway);
  const float moved = scene.off(got, scene.prior.mean, "LeftForeArm", kFrames - kAway, kAway);
  CHECK(held < 0.1F * moved);
}

TEST_CASE("fit to track: a velocity counts by its deviation") {
  Scene scene;
  scene.prior.mean = scene.right;
  const auto& kept = scene.modalities.pose_scale.kept_columns();
  const int velocity = scene.modalities.pose_features.velocity_feature();
  // A tracker's jitter, which the right velocity takes out of the path if it is trusted.
  for (int t = 0; t < kFrames; ++t) scene.track.x_px.row(t).array() += t % 2 ? 3 : -3;
  const auto roughness = [&](float deviation) {
    for (std::size_t k = 0; k < kept.size(); ++k)
      if (kept[k] >= velocity)
        scene.prior.deviation.col(static_cast<Eigen::Index>(k)).setConstant(deviation);
    const MatrixD off =
        path_of(scene.fit(std::nullopt).motion, "Hips") - path_of(scene.truth, "Hips");
    return (off.bottomRows(kFrames - 2) - 2 * off.middleRows(1, kFrames - 2) +
            off.topRows(kFrames - 2))
        .norm();
  };
  CHECK(roughness(0.01F) < 0.5 * roughness(1));
  CHECK(roughness(1) < 0.8 * roughness(100));
}

TEST_CASE("fit to track: what is shown is the motion through the camera, before it is moved") {
  Scene scene;
  scene.track.width_px = 1000;
  scene.track.height_px = 700;
  const FittedClip there = scene.fit();
  const Track2d seen = project_motion(there.motion, *scene.known.camera);
  CHECK(there.shown.x_px == seen.x_px);
  CHECK(there.shown.y_px == seen.y_px);
  CHECK(there.shown.joint_names == seen.joint_names);
  CHECK(there.shown.width_px == 1000);
  CHECK(there.shown.height_px == 700);
  // Without a camera the motion is put at the origin; what is shown still lies on the track.
  scene.prior.mean = scene.right;
  scene.known.camera.reset();
  scene.track.width_px = 1920;
  scene.track.height_px = 1080;
  const FittedClip moved = scene.fit();
  CHECK((moved.shown.x_px - scene.track.x_px).cwiseAbs().maxCoeff() < 2);
  CHECK(std::abs(path_of(moved.motion, "Hips")(0, 0)) < 1e-9);
}

TEST_CASE("fit to track: a prior of another shape or with an impossible deviation is refused") {
  const Scene scene;
  const auto fit = [&](const MatrixF& mean, const MatrixF& deviation) {
    return fit_to_track({mean, deviation}, scene.modalities, scene.track, scene.known, {});
  };
  const MatrixF &mean = scene.prior.mean, &deviation = scene.prior.deviation;
  CHECK_THROWS_AS(fit(mean.topRows(9), deviation.topRows(9)), ShapeError);
  CHECK_THROWS_AS(fit(mean.leftCols(9), deviation.leftCols(9)), ShapeError);
  CHECK_THROWS_AS(fit(mean, deviation.topRows(9)), ShapeError);
  CHECK_THROWS_AS(fit(mean, deviation.leftCols(9)), ShapeError);
  for (const float wrong :
       {-0.1F, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    MatrixF impossible = deviation;
    impossible(3, 4) = wrong;
    CHECK_THROWS_AS(fit(mean, impossible), InputError);
  }
  CHECK_NOTHROW(fit(mean, {}));
}

}  // namespace track_fit_test
