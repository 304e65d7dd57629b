#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/random_sequence.hpp"
#include "base/random_streams.hpp"
#include "camera/track_noise.hpp"
#include "corpus/no_augmentation.hpp"
#include "mcdbn/corpus/augmentation.hpp"
#include "mcdbn/synthesis/synthesize.hpp"
#include "motion/body_size.hpp"
#include "motion/mirror.hpp"
#include "motion/resample.hpp"

namespace augmented_view_settings_test {

using namespace mcdbn;
using test::nothing;

namespace {

constexpr double kFps = 25.0;

Motion walk() {
  SynthesisOptions options;
  options.fps = 100.0;
  options.seconds = 2.0;
  return synthesize(options);
}

CameraPlacement placement() {
  CameraPlacement placement;
  placement.azimuth_deg = -20.0;
  placement.elevation_deg = 5.0;
  placement.field_of_view_deg = 40.0;
  return placement;
}

/// A number within ±most, or 0 … 1, by what it decides.
double within(const RandomKey& key, std::uint32_t what, std::uint32_t column, double most) {
  return most * (2.0 * double{random_uniform(key, what, column)} - 1.0);
}
double share(const RandomKey& key, std::uint32_t what) {
  return double{random_uniform(key, what, 0)};
}

Motion expected_timing(const Motion& raw, const AugmentationSettings& settings,
                       const RandomKey& key) {
  Motion faster = raw;
  faster.frame_time_s = raw.frame_time_s / (1.0 + within(key, 0, 0, settings.speed));
  return resample(faster, kFps, 0.999 * share(key, 1));
}

void lengthen_bones(Motion& motion, double deviation, const RandomKey& key) {
  const double before = body_height(motion.skeleton);
  const std::vector<int> opposite = opposite_joints(motion.skeleton);
  for (int j = 0; j < motion.skeleton.joint_count(); ++j) {
    const int alike = std::min(j, opposite.empty() ? j : opposite[static_cast<std::size_t>(j)]);
    motion.skeleton.joints[static_cast<std::size_t>(j)].offset *=
        std::exp(deviation * random_normal(key, 5, static_cast<std::uint32_t>(alike)));
  }
  // The root of these clips is joint 0, whose first three channels are its position.
  motion.channels.leftCols(3) *= body_height(motion.skeleton) / before;
}

/// The rotation that joint j is held otherwise by.
Eigen::Matrix3d carriage(const RandomKey& key, int j, double deviation_deg) {
  Eigen::Vector3d turn;
  for (int axis = 0; axis < 3; ++axis)
    turn[axis] = deviation_deg * EIGEN_PI / 180.0 *
                 random_normal(key, 6, static_cast<std::uint32_t>(3 * j + axis));
  return Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
}

/// How far before the camera the middle of the box is that holds every joint of every frame.
double depth_of_middle(const Motion& motion, const Camera& camera) {
  const MatrixD points = joint_positions(motion);
  Eigen::Vector3d low = points.row(0).head<3>(), high = low;
  for (Eigen::Index t = 0; t < points.rows(); ++t)
    for (Eigen::Index c = 0; c < points.cols(); c += 3) {
      low = low.cwiseMin(points.row(t).segment<3>(c).transpose());
      high = high.cwiseMax(points.row(t).segment<3>(c).transpose());
    }
  return (camera.camera_from_world * (low + high) / 2 + camera.translation).z();
}

Camera expected_camera(const Motion& motion, const AugmentationSettings& settings,
                       const RandomKey& key) {
  CameraPlacement moved = placement();
  moved.azimuth_deg += within(key, 3, 0, settings.azimuth_deg);
  moved.elevation_deg += within(key, 3, 1, settings.elevation_deg);
  moved.distance = depth_of_middle(motion, place_camera(motion, moved)) *
                   std::exp(settings.distance * random_normal(key, 3, 2));
  return place_camera(motion, moved);
}

/// Root mean square distance from the frame's centre, of the joints that are seen.
double figure_px(const Track2d& track) {
  double sum = 0, count = 0;
  for (Eigen::Index t = 0; t < track.x_px.rows(); ++t) {
    std::vector<Eigen::Vector2d> seen;
    Eigen::Vector2d centre(0, 0);
    for (Eigen::Index j = 0; j < track.x_px.cols(); ++j)
      if (!std::isnan(track.x_px(t, j))) {
        seen.emplace_back(track.x_px(t, j), track.y_px(t, j));
        centre += seen.back();
      }
    for (const Eigen::Vector2d& joint : seen)
      sum += (joint - centre / static_cast<double>(seen.size())).squaredNorm();
    count += static_cast<double>(seen.size());
  }
  return std::sqrt(sum / count);
}

double largest(const MatrixD& difference) {
  return difference.cwiseAbs().maxCoeff();
}

bool same_numbers(const MatrixD& x, const MatrixD& y) {
  return x.rows() == y.rows() && x.cols() == y.cols() &&
         ((x.array() == y.array()) || (x.array().isNaN() && y.array().isNaN())).all();
}

/// What no setting but the one under test has to do with: everything that follows from the motion.
void check_camera_and_track(const AugmentedView& view, const AugmentationSettings& settings,
                            const RandomKey& key) {
  const Camera camera = expected_camera(view.motion, settings, key);
  CHECK(largest(view.camera.camera_from_world - camera.camera_from_world) < 1e-12);
  CHECK((view.camera.translation - camera.translation).norm() < 1e-9);
  CHECK(view.camera.fy_px == camera.fy_px);
  Track2d track = project_motion(view.motion, camera);
  add_pixel_noise(track, 2.0 * share(key, 4) * settings.noise_px * figure_px(track) / 200.0,
                  mixed_seed({key.seed, key.step, key.stream}));
  if (share(key, 7) < settings.missing)
    hide_limbs(track, view.motion.skeleton, mixed_seed({key.seed, key.step, key.stream}));
  REQUIRE(track.x_px.rows() == view.track.x_px.rows());
  const MatrixD x = view.track.x_px - track.x_px, y = view.track.y_px - track.y_px;
  CHECK(x.array().isNaN().cast<int>().sum() == track.x_px.array().isNaN().cast<int>().sum());
  CHECK(x.array().isNaN().select(0.0, x.array()).abs().maxCoeff() < 1e-6);
  CHECK(y.array().isNaN().select(0.0, y.array()).abs().maxCoeff() < 1e-6);
  CHECK(same_numbers(view.track.confidence, track.confidence));
}

constexpr std::uint32_t kKeys = 6;
RandomKey key_of(std::uint32_t step) {
  return {900, step, 11, 0};
}

AugmentedView view_of(const Motion& raw, const AugmentationSettings& settings,
                      const RandomKey& key) {
  return augmented_view(raw, kFps, placement(), settings, key);
}

/// With these settings the motion is that of the clip at another phase and speed.
void check_motion_as_captured(const AugmentationSettings& settings) {
  const Motion raw = walk();
  for (std::uint32_t step = 0; step < kKeys; ++step) {
    const AugmentedView view = view_of(raw, settings, key_of(step));
    const Motion want = expected_timing(raw, settings, key_of(step));
    CHECK(view.motion.frame_time_s == want.frame_time_s);
    CHECK(view.motion.channels == want.channels);
    for (std::size_t j = 0; j < raw.skeleton.joints.size(); ++j)
      CHECK(view.motion.skeleton.joints[j].offset == raw.skeleton.joints[j].offset);
    check_camera_and_track(view, settings, key_of(step));
  }
}

}  // namespace

TEST_CASE("a view without settings has a phase of its own and nothing else") {
  check_motion_as_captured(nothing());
  const Motion raw = walk();
  CHECK(view_of(raw, nothing(), key_of(0)).motion.channels !=
        view_of(raw, nothing(), key_of(1)).motion.channels);
}

TEST_CASE("each setting of the camera and of the track changes what it names, in every view anew") {
  const Motion raw = walk();
  const auto check = [&](double AugmentationSettings::*setting, double value) {
    AugmentationSettings settings = nothing();
    settings.*setting = value;
    check_motion_as_captured(settings);
    // Other keys than those of the phase: the same motion would show the same track.
    const AugmentedView plain = view_of(raw, nothing(), key_of(1)),
                        changed = view_of(raw, settings, key_of(1));
    CHECK_FALSE(same_numbers(plain.track.x_px, changed.track.x_px));
  };
  check(&AugmentationSettings::azimuth_deg, 15.0);
  check(&AugmentationSettings::elevation_deg, 12.0);
  check(&AugmentationSettings::distance, 0.2);
  check(&AugmentationSettings::noise_px, 3.0);
  check(&AugmentationSettings::missing, 1.0);
}

TEST_CASE("the camera's distance varies as much wherever in the room the clip is") {
  const Motion here = walk();
  Motion there = here;
  // The root of these clips is joint 0, whose first three channels are its position.
  there.channels.leftCols(3).rowwise() += Eigen::RowVector3d(-250, 30, 600);
  AugmentationSettings settings = nothing();
  settings.distance = 0.2;
  for (std::uint32_t step = 0; step < kKeys; ++step) {
    const double asked = std::exp(0.2 * random_normal(key_of(step), 3, 2));
    for (const Motion& raw : {here, there}) {
      const AugmentedView plain = view_of(raw, nothing(), key_of(step)),
                          changed = view_of(raw, settings, key_of(step));
      CHECK(depth_of_middle(changed.motion, changed.camera) /
                depth_of_middle(plain.motion, plain.camera) ==
            doctest::Approx(asked).epsilon(1e-9));
      CHECK(largest(changed.camera.camera_from_world - plain.camera.camera_from_world) == 0);
      CHECK((changed.camera.translation - plain.camera.translation).head<2>().norm() == 0);
    }
  }
}

TEST_CASE("a view in which some joints are behind the camera has noise on the others") {
  AugmentationSettings settings = nothing();
  settings.distance = 1.0;
  settings.noise_px = 0.5;
  const Motion raw = walk();
  int partly_seen = 0;
  for (std::uint32_t step = 0; step < 100; ++step) {
    const AugmentedView view = view_of(raw, settings, key_of(step));
    const Track2d exact = project_motion(view.motion, view.camera);
    const auto hidden = exact.x_px.array().isNaN().count();
    if (hidden == 0 || hidden == exact.x_px.size()) continue;
    const double deviation_px = share(key_of(step), 4) * figure_px(exact) / 200.0;
    if (!(deviation_px > 1)) continue;
    ++partly_seen;
    const MatrixD noise = view.track.x_px - exact.x_px;
    const auto known = noise.array().isNaN().select(0.0, noise.array()).eval();
    const double seen = static_cast<double>(noise.size() - hidden);
    // Its relative error over n numbers is 1 / sqrt(2 n); five of them.
    CHECK(std::sqrt(known.square().sum() / seen) ==
          doctest::Approx(std::min(deviation_px, 1000.0)).epsilon(5 / std::sqrt(2 * seen)));
  }
  CHECK(partly_seen > 0);
}

TEST_CASE("the largest noise of all is none too large for a view") {
  AugmentationSettings settings = nothing();
  settings.noise_px = 100.0;
  settings.distance = 1.0;
  const Motion raw = walk();
  for (std::uint32_t step = 0; step < 100; ++step)
    CHECK_NOTHROW(view_of(raw, settings, key_of(step)));
}

TEST_CASE("views of one number that are made for two purposes have nothing drawn in common") {
  AugmentationSettings noisy = nothing(), hiding = nothing(), detected = nothing();
  noisy.noise_px = 3.0;
  hiding.missing = 1.0;
  detected.detector = 1.0;
  const Motion raw = walk();
  int compared = 0, hidden_alike = 0;
  for (std::uint32_t step = 0; step < 12; ++step) {
    const auto both = [&](const AugmentationSettings& settings) {
      return std::pair{view_of(raw, settings, {900, step, random_streams::kScalingViews, 0}),
                       view_of(raw, settings, {900, step, random_streams::kAugmentedViews, 0})};
    };
    const auto noisy_views = both(noisy), hiding_views = both(hiding), seen = both(detected);
    if (noisy_views.first.motion.frames() != noisy_views.second.motion.frames()) continue;
    ++compared;
    const auto noise = [](const AugmentedView& view) {
      return MatrixD(view.track.x_px - project_motion(view.motion, view.camera).x_px);
    };
    const MatrixD one = noise(noisy_views.first), other = noise(noisy_views.second);
    // The correlation of n independent draws has a deviation of 1 / sqrt(n); five of them.
    CHECK(std::abs(one.cwiseProduct(other).sum()) <
          5 / std::sqrt(static_cast<double>(one.size())) * one.norm() * other.norm());
    hidden_alike +=
        same_numbers(hiding_views.first.track.confidence, hiding_views.second.track.confidence);
    const Eigen::Matrix3d turn =
        seen.first.camera.camera_from_world * seen.second.camera.camera_from_world.transpose();
    CHECK(Eigen::AngleAxisd(turn).angle() > 0.01);
  }
  CHECK(compared > 0);
  CHECK(hidden_alike < compared);
}

TEST_CASE("a view's speed is within the setting of the clip's, either way") {
  AugmentationSettings settings = nothing();
  settings.speed = 0.3;
  check_motion_as_captured(settings);
  const Motion raw = walk();
  int slower = 0, faster = 0;
  for (std::uint32_t step = 0; step < 20; ++step) {
    const int frames = view_of(raw, settings, key_of(step)).motion.frames();
    CHECK(frames >= std::floor(50 / 1.3) - 1);
    CHECK(frames <= std::ceil(50 / 0.7) + 1);
    slower += frames > 52;
    faster += frames < 48;
  }
  CHECK(slower > 2);
  CHECK(faster > 2);
}

TEST_CASE("every other view is a mirror's, the others are not") {
  AugmentationSettings settings = nothing();
  settings.mirror = true;
  const Motion raw = walk();
  int mirrors = 0;
  constexpr int kViews = 40;
  for (std::uint32_t step = 0; step < kViews; ++step) {
    const AugmentedView view = view_of(raw, settings, key_of(step));
    const Motion plain = expected_timing(raw, settings, key_of(step));
    const bool is_mirror = share(key_of(step), 2) < 0.5;
    CHECK(view.motion.channels == (is_mirror ? mirrored(plain)->channels : plain.channels));
    mirrors += is_mirror;
    if (step < kKeys) check_camera_and_track(view, settings, key_of(step));
  }
  CHECK(std::abs(mirrors - kViews / 2) < 5 * std::sqrt(kViews / 4.0));
}

TEST_CASE("bones of a view are longer or shorter, and the root's travel with them") {
  AugmentationSettings settings = nothing();
  settings.bone = 0.15;
  const Motion raw = walk();
  for (std::uint32_t step = 0; step < kKeys; ++step) {
    const AugmentedView view = view_of(raw, settings, key_of(step));
    Motion want = expected_timing(raw, settings, key_of(step));
    lengthen_bones(want, settings.bone, key_of(step));
    CHECK(largest(view.motion.channels - want.channels) < 1e-9);
    for (std::size_t j = 0; j < raw.skeleton.joints.size(); ++j)
      CHECK((view.motion.skeleton.joints[j].offset - want.skeleton.joints[j].offset).norm() < 1e-9);
    check_camera_and_track(view, settings, key_of(step));
  }
}

TEST_CASE("each joint of a view is held otherwise by one small turn throughout the clip") {
  AugmentationSettings settings = nothing();
  settings.turn_deg = 6.0;
  const Motion raw = walk();
  const Skeleton& skeleton = raw.skeleton;
  int turned = 0;
  for (std::uint32_t step = 0; step < 2; ++step) {
    const AugmentedView view = view_of(raw, settings, key_of(step));
    const Motion plain = expected_timing(raw, settings, key_of(step));
    for (int j = 0; j < skeleton.joint_count(); ++j) {
      const Joint& joint = skeleton.joints[static_cast<std::size_t>(j)];
      const int first = skeleton.first_channel(j);
      const auto count = static_cast<Eigen::Index>(joint.channels.size());
      const MatrixD own = plain.channels.middleCols(first, count);
      const bool turns =
          j > 0 && count > 0 && (own.rowwise() - own.row(0)).cwiseAbs().maxCoeff() >= 1e-9;
      if (!turns) {
        CHECK(view.motion.channels.middleCols(first, count) == own);
        continue;
      }
      ++turned;
      const Eigen::Matrix3d carried = carriage(key_of(step), j, settings.turn_deg);
      for (int t = 0; t < plain.frames(); t += 7)
        CHECK(largest(local_rotation(joint, view.motion.channels.row(t).data() + first) -
                      local_rotation(joint, plain.channels.row(t).data() + first) * carried) <
              1e-9);
      // Angles run on continuously.
      const MatrixD angles = view.motion.channels.middleCols(first, count);
      CHECK((angles.bottomRows(angles.rows() - 1) - angles.topRows(angles.rows() - 1))
                .cwiseAbs()
                .maxCoeff() < 180.0);
    }
    check_camera_and_track(view, settings, key_of(step));
  }
  CHECK(turned > 10);
}

}  // namespace augmented_view_settings_test
