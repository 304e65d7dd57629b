// Pitch, roll and focal length of an uncalibrated camera, found by the fit.

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "camera/track_noise.hpp"
#include "fitting/camera_angles.hpp"
#include "fitting/camera_scene.hpp"
#include "motion/foot_joints.hpp"

namespace unknown_camera_test {

using namespace mcdbn;
using namespace mcdbn::test;

using Scene = CameraScene;

TEST_CASE("unknown camera: pitch and roll are those that make an upright walker") {
  for (const double pitch_deg : {-8.0, 0.0, 12.0, 25.0})
    for (const double roll_deg : {0.0, 5.0, -4.0}) {
      CAPTURE(pitch_deg);
      CAPTURE(roll_deg);
      const Scene scene(pitch_deg, roll_deg);
      const AssumedView view = scene.fit({{}, {}, scene.view.field_of_view_deg}).view;
      CHECK(std::abs(*view.pitch_deg - pitch_deg) < 2 + 0.15 * std::abs(pitch_deg));
      CHECK(std::abs(*view.roll_deg - roll_deg) < 1.5);
      CHECK(*view.field_of_view_deg == doctest::Approx(40));
    }
}

TEST_CASE(
    "unknown camera: its pitch is found as well where it lies on its side or is upside down") {
  const auto found = [](double roll_deg) {
    const Scene scene(12, roll_deg);
    const AssumedView view = scene.fit({{}, roll_deg, scene.view.field_of_view_deg}).view;
    CHECK(std::abs(std::remainder(*view.roll_deg - roll_deg, 360)) < 1e-6);
    return *view.pitch_deg;
  };
  const double upright = found(0);
  CHECK(std::abs(upright - 12) < 3.8);
  for (const double roll_deg : {40.0, 90.0, -90.0, 180.0}) {
    CAPTURE(roll_deg);
    CHECK(std::abs(found(roll_deg) - upright) < 0.1);
  }
}

TEST_CASE("unknown camera: rolls differ the short way round") {
  const auto up = [](double roll_deg) {
    const double roll = roll_deg * EIGEN_PI / 180;
    return Eigen::Vector3d(-std::sin(roll), -std::cos(roll), 0);
  };
  for (const double from_deg : {0.0, 90.0, 179.0, -179.0})
    for (const double by_deg : {-20.0, 2.0, 100.0}) {
      CAPTURE(from_deg);
      CAPTURE(by_deg);
      CHECK(roll_from_to_rad(up(from_deg), up(from_deg + by_deg)) ==
            doctest::Approx(by_deg * EIGEN_PI / 180));
    }
}

TEST_CASE("unknown camera: what was given stays") {
  const Scene scene(12, 3);
  AssumedView given;
  given.pitch_deg = 12;
  CHECK(*scene.fit(given).view.pitch_deg == doctest::Approx(12));
  CHECK(std::abs(*scene.fit(given).view.roll_deg - 3) < 1.5);
  given.pitch_deg = 3;  // however wrong
  given.roll_deg = -2;
  given.field_of_view_deg = 50;
  const AssumedView view = scene.fit(given).view;
  CHECK(*view.pitch_deg == doctest::Approx(3));
  CHECK(*view.roll_deg == doctest::Approx(-2));
  CHECK(*view.field_of_view_deg == doctest::Approx(50));
}

TEST_CASE("unknown camera: what was found before is where the search starts, and no more") {
  const Scene scene(12, 0);
  KnownOfClip known{std::nullopt, scene.truth.skeleton};
  known.view.field_of_view_deg = 40;
  const auto pitch_deg = [&] {
    return *fit_to_track(scene.pose, scene.modalities, scene.track, known, TrackFitSettings{})
                .view.pitch_deg;
  };
  const double from_level = pitch_deg();
  // The answer is taken to be upright in the view that was found: from the right one nothing moves.
  known.found = {12, 0, {}};
  CHECK(std::abs(pitch_deg() - 12) < std::abs(from_level - 12) + 0.5);
  known.found.pitch_deg = 30;  // only a start
  CHECK(pitch_deg() < 25);
}

TEST_CASE("unknown camera: of a long clip a detector's track is as the rough solution has it") {
  const Scene scene(12, 3, SynthesisAction::walk, 14);  // two windows
  KnownOfClip known;
  TrackFitSettings rough;
  rough.most_solutions = 0;
  const auto fit = [&](const TrackFitSettings& settings) {
    return fit_to_track(scene.pose, scene.modalities, scene.track, known, settings);
  };
  for (const bool detected : {true, false}) {
    CAPTURE(detected);
    known.detected = detected;
    for (const bool body_known : {true, false}) {
      CAPTURE(body_known);
      known.skeleton.reset();
      if (body_known) known.skeleton = scene.truth.skeleton;
      const FittedClip roughly = fit(rough), finally = fit({});
      // What may be exact is found anew, with the noise that it has.
      const bool as_found = detected || !body_known;
      CHECK((*roughly.view.pitch_deg == *finally.view.pitch_deg) == as_found);
      CHECK((roughly.motion.skeleton.joints[1].offset == finally.motion.skeleton.joints[1].offset));
      CHECK(roughly.motion.channels != finally.motion.channels);
    }
  }
}

TEST_CASE("unknown camera: the focal length gives way to what the track shows") {
  // Seen by a longer lens than the 60 degrees across that are assumed: walking away, people shrink
  // less.
  const Scene scene(5, 0);
  TrackFitSettings stiff;
  stiff.focal_log_deviation = 1e-3;
  const auto off = [&](const AssumedView& view) {
    return std::abs(std::log(std::tan(*view.field_of_view_deg * EIGEN_PI / 360) /
                             std::tan(40 * EIGEN_PI / 360)));
  };
  CHECK(*scene.fit({}, stiff).view.field_of_view_deg ==
        doctest::Approx(usual_field_of_view_deg(1920, 1080)).epsilon(0.01));
  CHECK(off(scene.fit({}).view) < off(scene.fit({}, stiff).view));
}

TEST_CASE("unknown camera: the answer is seen where the track shows it, through that camera") {
  const Scene scene(12, 4);
  const FittedClip clip = scene.fit({});
  const Track2d seen = project_motion(clip.motion, clip.camera);
  const double off_px = ((seen.x_px - scene.track.x_px).cwiseAbs().mean() +
                         (seen.y_px - scene.track.y_px).cwiseAbs().mean());
  CHECK(off_px < 6);
  CHECK((seen.x_px - clip.shown.x_px).cwiseAbs().maxCoeff() < 1e-6);
  CHECK((seen.y_px - clip.shown.y_px).cwiseAbs().maxCoeff() < 1e-6);
}

TEST_CASE(
    "unknown camera: ankles stand as high as a person's do, wherever the prior has the root") {
  for (const double raised_cm : {-25.0, 0.0, 25.0}) {
    CAPTURE(raised_cm);
    Scene scene(12, 0);
    scene.raise_prior(raised_cm);
    const Motion motion = scene.fit({{}, {}, scene.view.field_of_view_deg}).motion;
    CHECK(std::abs(scene.ankles_above_truth_cm(motion)) < 2);
  }
}

TEST_CASE("unknown camera: standing feet are on one level") {
  Scene scene(12, 0);
  add_pixel_noise(scene.track, 8, 3);
  const MatrixD truth = joint_positions(scene.truth);
  const auto spread = [&](double ground_m) {
    TrackFitSettings settings;
    settings.ground_deviation_m = ground_m;
    settings.ground_observation_s = 1 / scene.track.fps;  // every frame counts
    const Motion motion = fit_to_track(scene.pose, scene.modalities, scene.track,
                                       {scene.camera, scene.truth.skeleton}, settings)
                              .motion;
    const MatrixD positions = joint_positions(motion);
    std::vector<double> heights;
    for (const int foot : foot_joints(scene.truth.skeleton)) {
      const Eigen::VectorXd real = truth.col(3 * foot + 1), got = positions.col(3 * foot + 1);
      for (Eigen::Index t = 0; t < real.size(); ++t)
        if (real[t] < real.minCoeff() + 1) heights.push_back(got[t] - real[t]);  // cm
    }
    const Eigen::Map<const Eigen::ArrayXd> all(heights.data(), std::ssize(heights));
    return std::sqrt((all - all.mean()).square().mean());
  };
  CHECK(spread(0.01) < 0.5 * spread(100));
}

}  // namespace unknown_camera_test
