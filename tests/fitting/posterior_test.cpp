// The likeliest motion, of a walk whose prior is wrong in ways unknown to the fit.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "camera/track_noise.hpp"
#include "fitting/walk_scene.hpp"
#include "mcdbn/base/errors.hpp"
#include "motion/foot_joints.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// RMS distance of the joints from the truth's, relative to the root, cm.
double error_cm(const Scene& scene, const Motion& motion) {
  MatrixD off = joint_positions(motion) - joint_positions(scene.truth);
  off -= off.leftCols<3>().eval().replicate(1, off.cols() / 3);
  return std::sqrt(3 * off.squaredNorm() / static_cast<double>(off.size()));
}

/// RMS distance from where a track has the joints, px, x and y each.
double miss_px(const Scene& scene, const Motion& motion, const Track2d& seen) {
  const Track2d shown = project_motion(motion, *scene.known.camera);
  const double squares =
      (shown.x_px - seen.x_px).squaredNorm() + (shown.y_px - seen.y_px).squaredNorm();
  return std::sqrt(squares / static_cast<double>(2 * shown.x_px.size()));
}

}  // namespace

TEST_CASE("posterior: a wrong prior comes back to the truth, and to the track") {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    CAPTURE(seed);
    const Scene scene = make_scene(seed);
    const Motion fitted = scene.fit();
    CHECK(miss_px(scene, scene.unfitted(), scene.track) > 8);
    CHECK(miss_px(scene, fitted, scene.track) < 1);
    CHECK(error_cm(scene, fitted) < 0.4 * error_cm(scene, scene.unfitted()));
  }
}

TEST_CASE(
    "posterior: a rough solution comes back to the truth, too, but not to every frame's track") {
  const Scene scene = make_scene();
  TrackFitSettings rough;
  rough.most_solutions = 0;
  const Motion fitted = scene.fit(scene.track, rough);
  CHECK(error_cm(scene, fitted) < 0.4 * error_cm(scene, scene.unfitted()));
  CHECK(miss_px(scene, fitted, scene.track) > miss_px(scene, scene.fit(), scene.track));
}

TEST_CASE("posterior: limbs are tried on other sides in depth, where the track is exact") {
  Scene scene = make_scene(4);
  TrackFitSettings with, without;
  with.least_noise_px = without.least_noise_px = 10;  // energies of the same noise
  without.most_alternatives = 0;
  const auto fitted = [&](const TrackFitSettings& settings) {
    return fit_to_track(scene.mean, scene.modalities, scene.track, scene.known, settings);
  };
  CHECK(fitted(with).energy < fitted(without).energy - 1);
  CHECK(error_cm(scene, fitted(with).motion) < 0.3 * error_cm(scene, fitted(without).motion));
  scene.known.detected = true;
  CHECK(fitted(with).energy == fitted(without).energy);
}

TEST_CASE("posterior: an exact track is met as exactly, a detector's is not") {
  Scene scene = make_scene(4);
  TrackFitSettings as_noisy;
  as_noisy.least_noise_px = 10;
  CHECK(error_cm(scene, scene.fit()) < 0.1 * error_cm(scene, scene.fit(scene.track, as_noisy)));
  CHECK(miss_px(scene, scene.fit(), scene.track) < 0.01);
  scene.known.detected = true;
  CHECK(scene.fit().channels == scene.fit(scene.track, as_noisy).channels);
}

TEST_CASE(
    "posterior: noise that solutions measured has settings of its own, a detector's has not") {
  Scene scene = make_scene(1, 40);
  add_pixel_noise(scene.track, 5, 1);
  TrackFitSettings others;
  others.measured_prior_error_time_s = 0.05;
  CHECK(scene.fit().channels != scene.fit(scene.track, others).channels);
  scene.known.detected = true;
  CHECK(scene.fit().channels == scene.fit(scene.track, others).channels);
}

TEST_CASE("posterior: the same again, bit for bit") {
  const Scene scene = make_scene(1, 20);
  CHECK(scene.fit().channels == scene.fit().channels);
}

TEST_CASE("posterior: a right prior stays") {
  const Scene scene = make_scene(0);
  CHECK(error_cm(scene, scene.fit()) < 0.1);
}

TEST_CASE("posterior: missing joints are ignored, whatever number stands there") {
  const Scene scene = make_scene(1, 30);
  Track2d missing = scene.track;
  drop_joints(missing, 0.3, 3);
  const Motion fitted = scene.fit(missing);
  CHECK(error_cm(scene, fitted) < 0.5 * error_cm(scene, scene.unfitted()));
  Track2d wild = missing;
  for (Eigen::Index k = 0; k < wild.x_px.size(); ++k)
    if (wild.confidence.data()[k] == 0) wild.x_px.data()[k] = wild.y_px.data()[k] = 1e5;
  CHECK(scene.fit(wild).channels == fitted.channels);
}

TEST_CASE("posterior: a joint that the tracker takes for another is let go of") {
  const Scene scene = make_scene();
  Track2d swapped = scene.track;
  const int hand = swapped.find("LeftHand");
  REQUIRE(hand >= 0);
  swapped.x_px.col(hand).segment(20, 6).array() += 300;
  TrackFitSettings as_noisy;
  as_noisy.least_noise_px = 10;
  const double clean_cm = error_cm(scene, scene.fit(scene.track, as_noisy));
  CHECK(error_cm(scene, scene.fit(swapped, as_noisy)) < 1.3 * clean_cm);
  CHECK(error_cm(scene, scene.fit(swapped)) < 1.3 * clean_cm);
}

TEST_CASE("posterior: noise is smoothed away, not followed") {
  const Scene scene = make_scene();
  Track2d noisy = scene.track;
  add_pixel_noise(noisy, 5, 1);
  const Motion fitted = scene.fit(noisy);
  CHECK(error_cm(scene, fitted) < 0.7 * error_cm(scene, scene.unfitted()));
  // Nearer to what there was to see than the track itself is.
  CHECK(miss_px(scene, fitted, scene.track) < 0.7 * 5);
}

TEST_CASE(
    "posterior: the surer a detector is of a joint, the nearer the joint comes to its place") {
  const Scene scene = make_scene(0, 30);
  Track2d moved = scene.track;
  add_pixel_noise(moved, 3, 4);
  const int hand = moved.find("LeftHand");
  moved.x_px.col(hand).array() += 10;
  const auto followed_px = [&](double confidence) {
    moved.confidence.col(hand).setConstant(confidence);
    const Track2d shown = project_motion(scene.fit(moved), *scene.known.camera);
    return (shown.x_px - scene.track.x_px).col(hand).mean();
  };
  const double hardly_px = followed_px(0.001), surely_px = followed_px(1);
  CHECK(hardly_px < 0.5 * surely_px);
  CHECK(surely_px > 3);
}

TEST_CASE("posterior: the root's way bends as the prior's velocity does") {
  Scene scene = make_scene(0, 30);
  // A tracker's jitter, of the whole body.
  for (int t = 0; t < 30; ++t) scene.track.x_px.row(t).array() += t % 2 ? 3 : -3;
  const auto roughness = [&](double root_m_s2) {
    TrackFitSettings settings;
    settings.root_m_s2 = root_m_s2;
    settings.planted_foot_speed_m_s = 1e3;
    const MatrixD off =
        path_of(scene.fit(scene.track, settings), "Hips") - path_of(scene.truth, "Hips");
    return (off.bottomRows(28) - 2 * off.middleRows(1, 28) + off.topRows(28)).norm();
  };
  CHECK(roughness(0.3) < 0.5 * roughness(1e3));
}

TEST_CASE("posterior: feet that stand stay where they stand") {
  Scene scene = make_scene(1);
  Track2d noisy = scene.track;
  add_pixel_noise(noisy, 5, 2);
  const auto slide = [&](double speed_m_s) {
    TrackFitSettings settings;
    settings.planted_foot_speed_m_s = speed_m_s;
    const MatrixD places = joint_positions(scene.fit(noisy, settings));
    const MatrixD truth = joint_positions(scene.truth);
    double sum = 0;
    for (const int foot : foot_joints(scene.truth.skeleton))
      for (Eigen::Index t = 1; t < places.rows(); ++t) {
        const auto step = [&](const MatrixD& of) {
          return (of.row(t) - of.row(t - 1)).segment<3>(3 * foot).norm();
        };
        if (step(truth) < 0.3) sum += step(places);  // cm
      }
    return sum;
  };
  CHECK(slide(0.5) < 0.8 * slide(1e3));
}

TEST_CASE("posterior: a limb behind the camera does not blow up") {
  Scene scene = make_scene(1, 30);
  // The root half a metre before the camera, some joints behind it.
  Camera& camera = *scene.known.camera;
  const Eigen::Vector3d root = joint_positions(scene.truth).row(15).leftCols<3>().transpose();
  camera.distortion.clear();
  camera.translation = Eigen::Vector3d(0, 0, 50) - camera.camera_from_world * root;
  scene.track = project_motion(scene.truth, camera);
  CHECK(scene.fit().channels.allFinite());
}

TEST_CASE("posterior: one frame, two frames, no frame") {
  for (const int frames : {1, 2}) {
    CAPTURE(frames);
    const Scene few = make_scene(1, frames);
    CHECK(error_cm(few, few.fit()) < 0.7 * error_cm(few, few.unfitted()));
  }
  Scene none = make_scene(1, 1);
  none.mean.conservativeResize(0, Eigen::NoChange);
  for (MatrixD* values : {&none.track.x_px, &none.track.y_px, &none.track.confidence})
    values->conservativeResize(0, Eigen::NoChange);
  CHECK_THROWS_AS(none.fit(), InputError);
}

TEST_CASE("posterior: a rough solution takes no track for exact") {
  const Scene scene = make_scene(1, 30);
  TrackFitSettings settings, other;
  other.exact_parent_correlation = 0.9;
  CHECK(scene.fit(scene.track, settings).channels != scene.fit(scene.track, other).channels);
  settings.most_solutions = other.most_solutions = 0;
  CHECK(scene.fit(scene.track, settings).channels == scene.fit(scene.track, other).channels);
}

TEST_CASE("posterior: a long clip is solved in windows, and nothing jumps between them") {
  // Seven walks, one after the other and back, so that neighbouring frames are neighbours.
  Scene scene = make_scene(1);
  const Eigen::Index once = scene.truth.channels.rows();
  MatrixD channels(7 * once, scene.truth.channels.cols());
  MatrixF mean(7 * once, scene.mean.cols());
  Track2d track = scene.track;
  for (MatrixD* values : {&track.x_px, &track.y_px, &track.confidence})
    values->resize(7 * once, scene.track.joint_count());
  for (Eigen::Index t = 0; t < channels.rows(); ++t) {
    const Eigen::Index phase = t % (2 * once), from = phase < once ? phase : 2 * once - 1 - phase;
    channels.row(t) = scene.truth.channels.row(from);
    mean.row(t) = scene.mean.row(from);
    track.x_px.row(t) = scene.track.x_px.row(from);
    track.y_px.row(t) = scene.track.y_px.row(from);
    track.confidence.row(t) = scene.track.confidence.row(from);
  }
  scene.truth.channels = channels;
  scene.mean = mean;
  scene.track = track;
  TrackFitSettings settings;
  // Else not all walks find the same of two places that are about as likely.
  settings.exact_prior_weight = 1;
  settings.most_alternatives = 0;
  const Motion fitted = scene.fit(scene.track, settings);
  CHECK(error_cm(scene, fitted) < 0.4 * error_cm(scene, scene.unfitted()));
  const MatrixD off = joint_positions(fitted) - joint_positions(scene.truth);
  // Frames 180 to 240 are in two windows; 120 frames later everything is the same, in one.
  constexpr Eigen::Index kAgain = 120, kFirst = 250, kCount = 95;
  const MatrixD change = off.middleRows(kFirst, kCount) - off.middleRows(kFirst - kAgain, kCount);
  CHECK(change.cwiseAbs().maxCoeff() < 0.2);  // cm
}
