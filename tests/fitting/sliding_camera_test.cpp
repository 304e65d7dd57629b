// The fit of a clip that is still growing, through a camera of which it is not known how it stands.

#include <doctest/doctest.h>

#include <cmath>

#include "base/numbers.hpp"
#include "fitting/camera_angles.hpp"
#include "fitting/camera_scene.hpp"
#include "fitting/sliding_scene.hpp"

// Ceres includes glog, which has a CHECK of its own.
#undef CHECK
#define CHECK DOCTEST_CHECK

namespace sliding_camera_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr Eigen::Index kLag = 8;

KnownOfClip known_of(const CameraScene& scene) {
  return {std::nullopt, scene.truth.skeleton, {{}, {}, scene.view.field_of_view_deg}};
}

double pitch_deg(const Camera& camera) {
  return pitch_rad(camera.camera_from_world.col(1)) / kRadiansPerDegree;
}
double roll_deg(const Camera& camera) {
  return roll_rad(camera.camera_from_world.col(1)) / kRadiansPerDegree;
}

/// How far from upright the trunk is on average, from frame `first` on.
double tilt_deg(const Motion& motion, Eigen::Index first) {
  const MatrixD trunk = joints_about(motion, {"Neck"}, "Hips").bottomRows(motion.frames() - first);
  return std::acos(trunk.colwise().mean().normalized()[1]) / kRadiansPerDegree;
}

}  // namespace

TEST_CASE("a sliding fit: how an unknown camera stands is found, and the body stays upright") {
  const CameraScene scene(25, 5, SynthesisAction::walk, 2);
  SlidingFit fit(scene.modalities, known_of(scene), scene.track, {});
  const MatrixD channels =
      settled_channels(fit, scene.pose, scene.track, kLag, [](Eigen::Index) {});
  // The whole clip's fit leaves about a degree of the pitch.
  CHECK(std::abs(pitch_deg(fit.camera()) - 25) < 5);
  CHECK(std::abs(roll_deg(fit.camera()) - 5) < 2);
  const Motion motion{fit.body(), scene.truth.frame_time_s, channels};
  CHECK(std::abs(tilt_deg(motion, 30) - tilt_deg(scene.truth, 30)) < 6);
}

TEST_CASE("a sliding fit: an unknown camera's ground is that under the ankles") {
  CameraScene scene(12, 0, SynthesisAction::walk, 1);
  scene.raise_prior(25);
  SlidingFit fit(scene.modalities, known_of(scene), scene.track, {});
  const MatrixD channels =
      settled_channels(fit, scene.pose, scene.track, kLag, [](Eigen::Index) {});
  const Motion motion{fit.body(), scene.truth.frame_time_s, channels};
  CHECK(std::abs(scene.ankles_above_truth_cm(motion)) < 4);
}

TEST_CASE("a sliding fit: the balance counts from the first frames on, by all frames' bent legs") {
  const CameraScene scene(10, 0, SynthesisAction::walk, 2);
  struct Pitches {
    double early_deg = 0, late_deg = 0;
  };
  const auto pitches = [&](double balance_bent_legs) {
    TrackFitSettings settings;
    settings.pitch_deviation_deg = 3;  // without balance the camera is taken to look level
    settings.balance_deviation_deg = 1;
    settings.balance_speed_m_s = 1e3;
    settings.balance_bent_legs = balance_bent_legs;
    SlidingFit fit(scene.modalities, known_of(scene), scene.track, settings);
    Pitches found;
    settled_channels(fit, scene.pose, scene.track, kLag, [&](Eigen::Index frames) {
      if (frames == kLag + 3) found.early_deg = pitch_deg(fit.camera());  // nothing is dropped yet
    });
    found.late_deg = pitch_deg(fit.camera());
    return found;
  };
  const Pitches balanced = pitches(1e3), hardly = pitches(0.02);
  CHECK(balanced.early_deg > hardly.early_deg + 2);
  CHECK(balanced.late_deg > hardly.late_deg + 1.5);
}

TEST_CASE("a sliding fit: what it finds by looking back is rough, and does not count as exact") {
  const CameraScene scene(25, 0, SynthesisAction::walk, 1);
  const auto camera_after = [&](double exact_parent_correlation) {
    TrackFitSettings settings;
    settings.exact_parent_correlation = exact_parent_correlation;
    SlidingFit fit(scene.modalities, known_of(scene), scene.track, settings);
    fit.solve(some_rows(scene.pose, 0, 28), some_rows(scene.track, 0, 28), 0);
    const Eigen::Index dropped = fit.settle(20);
    const Eigen::Index held = fit.held();
    fit.solve(some_rows(scene.pose, dropped + held, 29 - dropped - held),
              some_rows(scene.track, dropped, 29 - dropped), 0);
    return pitch_deg(fit.camera());
  };
  CHECK(std::abs(camera_after(0.9) - camera_after(0.1)) < 0.5);
}

}  // namespace sliding_camera_test
