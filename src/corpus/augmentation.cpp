#include "mcdbn/corpus/augmentation.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/numbers.hpp"
#include "base/random_sequence.hpp"
#include "camera/detector_track.hpp"
#include "camera/keypoint_map.hpp"
#include "camera/random_camera.hpp"
#include "camera/track_noise.hpp"
#include "corpus/new_poses.hpp"
#include "mcdbn/camera/joint_sets.hpp"
#include "motion/mirror.hpp"
#include "motion/other_body.hpp"
#include "motion/resample.hpp"
#include "motion/turned_motion.hpp"

namespace mcdbn {
namespace {

/// Which number of a view a draw decides; the column counts joints and axes.
enum Draw : std::uint32_t {
  kSpeed,
  kPhase,
  kMirroring,
  kCamera,
  kNoise,
  kBones,
  kTurning,
  kMissing,
  kDetector,
  kGravity
};

double uniform(const RandomKey& key, Draw draw, std::uint32_t column = 0) {
  return static_cast<double>(random_uniform(key, draw, column));
}
double within(const RandomKey& key, Draw draw, std::uint32_t column, double most) {
  return most * (2.0 * uniform(key, draw, column) - 1.0);
}

/// Seed for what draws one number after another: each stream's views have their own.
std::uint64_t seed_of(const RandomKey& key) {
  return mixed_seed({key.seed, key.step, key.stream});
}

/// Every joint below the root that turns at all is turned by a fixed small rotation of its own.
void change_carriage(Motion& motion, double deviation_deg, const RandomKey& key) {
  const double deviation = deviation_deg * kRadiansPerDegree;
  for (int j = 1; j < motion.skeleton.joint_count(); ++j) {
    const Joint& joint = motion.skeleton.joints[j];
    const int first = motion.skeleton.first_channel(j);
    const auto count = static_cast<Eigen::Index>(joint.channels.size());
    const auto own = motion.channels.middleCols(first, count);
    if (count == 0 || (own.rowwise() - own.row(0)).cwiseAbs().maxCoeff() < 1e-9) continue;
    Eigen::Vector3d turn;
    for (int axis = 0; axis < 3; ++axis)
      turn[axis] =
          deviation * random_normal(key, kTurning, static_cast<std::uint32_t>(3 * j + axis));
    const Eigen::Matrix3d rotation =
        Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
    for (int t = 0; t < motion.frames(); ++t) {
      double* channels = motion.channels.row(t).data() + first;
      set_local_rotation(joint, local_rotation(joint, channels) * rotation,
                         t > 0 ? motion.channels.row(t - 1).data() + first : nullptr, channels);
    }
  }
}

Motion other_timing(const Motion& raw, double fps, double speed, const RandomKey& key) {
  Motion faster = raw;
  faster.frame_time_s /= 1.0 + within(key, kSpeed, 0, speed);
  constexpr double kBelowOne = 0.999;  // a phase of 1 would be the next frame
  return resample(faster, fps, kBelowOne * uniform(key, kPhase));
}

/// RMS distance of the joints from their centre, over all that are seen; 0 if none is.
double size_px(const Track2d& track) {
  double sum = 0;
  Eigen::Index count = 0;
  for (Eigen::Index t = 0; t < track.frames(); ++t) {
    const Eigen::ArrayXd x = track.x_px.row(t).transpose(), y = track.y_px.row(t).transpose();
    const auto seen = x.isFinite() && y.isFinite();
    const Eigen::Index joints = seen.count();
    if (joints == 0) continue;
    for (const Eigen::ArrayXd& axis : {x, y}) {
      const double centre = seen.select(axis, 0.0).sum() / static_cast<double>(joints);
      sum += seen.select(axis - centre, 0.0).square().sum();
    }
    count += joints;
  }
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0.0;
}

/// How far before the camera the middle of the joints' box is, at which place_camera aims.
double depth_of(const Motion& motion, const Camera& camera) {
  const MatrixD points = joint_positions(motion);
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>> places(
      points.data(), points.size() / 3, 3);
  const Eigen::RowVector3d middle =
      0.5 * (places.colwise().minCoeff() + places.colwise().maxCoeff());
  return camera.camera_from_world.row(2).dot(middle) + camera.translation.z();
}

/// The view's motion as a detector sees it from anywhere.
void see_by_detector(AugmentedView& view, const RandomKey& key) {
  const std::uint64_t seed = mixed_seed({key.seed, key.step, key.stream, 0x64657465});
  view.camera = random_camera(view.motion, {}, seed);
  const auto which = static_cast<std::size_t>(uniform(key, kDetector, 1) *
                                              static_cast<double>(detectors().size()));
  const Detector& detector = detectors()[std::min(which, detectors().size() - 1)];
  const std::vector<Keypoint>& keypoints = joint_set(detector.joint_set).keypoints;
  const SkeletonRoles roles = skeleton_roles(view.motion.skeleton);
  const Track2d seen =
      detector_track(view.motion, roles, keypoints, view.camera, detector.noise, seed);
  // Regeneration takes off what lies between keypoint and joint as its answer has it; an answer
  // that learns from the truth comes near the truth.
  view.track =
      KeypointMap(keypoints, view.motion.skeleton, roles).joints_of(seen, view.motion, view.camera);
}

/// An error of the direction taken as down: the camera that the network is given and the answer
/// that it is to give turn by the same about a level axis; the track, the heights and the truth in
/// the image stay.
void misjudge_gravity(AugmentedView& view, double deviation_deg, const RandomKey& key) {
  const double angle = deviation_deg * kRadiansPerDegree * random_normal(key, kGravity, 0),
               about = 2 * EIGEN_PI * uniform(key, kGravity, 1);
  const Eigen::Matrix3d error =
      Eigen::AngleAxisd(angle, Eigen::Vector3d(std::cos(about), 0, std::sin(about)))
          .toRotationMatrix();
  const int root = moving_root({&view.motion});
  const MatrixD path = joint_positions(view.motion).middleCols(3 * root, 3);
  const Eigen::VectorXd was = path.col(1), turned = path * error.row(1).transpose();
  view.motion = turned_motion(std::move(view.motion), error, was - turned);
  view.camera.camera_from_world = view.camera.camera_from_world * error.transpose();
}

/// The clip seen otherwise, gravity known.
AugmentedView seen_view(const Motion& raw, double fps, const CameraPlacement& placement,
                        const AugmentationSettings& settings, const RandomKey& key,
                        bool hide_no_limb, const PosePool* pool) {
  AugmentedView view;
  view.motion = other_timing(raw, fps, settings.speed, key);
  if (settings.mirror && uniform(key, kMirroring) < 0.5)
    if (auto other = mirrored(view.motion)) view.motion = std::move(*other);
  if (pool != nullptr) view.motion = with_new_poses(view.motion, settings, *pool, key);
  if (settings.bone > 0)
    scale_bones(view.motion, [&](int joint) {
      return std::exp(settings.bone *
                      random_normal(key, kBones, static_cast<std::uint32_t>(joint)));
    });
  if (settings.turn_deg > 0) change_carriage(view.motion, settings.turn_deg, key);
  if (uniform(key, kDetector) < settings.detector) {
    see_by_detector(view, key);
    return view;
  }
  CameraPlacement moved = placement;
  moved.azimuth_deg += within(key, kCamera, 0, settings.azimuth_deg);
  moved.elevation_deg += within(key, kCamera, 1, settings.elevation_deg);
  view.camera = place_camera(view.motion, moved);
  if (settings.distance > 0) {
    const double farther = std::exp(settings.distance * random_normal(key, kCamera, 2));
    view.camera.translation.z() += (farther - 1) * depth_of(view.motion, view.camera);
  }
  view.track = project_motion(view.motion, view.camera);
  constexpr double kUsualSize_px = 200.0;  // of a figure that fills the image
  // A camera right before a joint shows figures of any size.
  const double noise_px =
      2.0 * uniform(key, kNoise) * settings.noise_px * size_px(view.track) / kUsualSize_px;
  add_pixel_noise(view.track, std::min(noise_px, TrackDamage::kNoise_px.most), seed_of(key));
  if (!hide_no_limb && uniform(key, kMissing) < settings.missing)
    hide_limbs(view.track, view.motion.skeleton, seed_of(key));
  return view;
}

}  // namespace

AugmentedView augmented_view(const Motion& raw, double fps, const CameraPlacement& placement,
                             const AugmentationSettings& settings, const RandomKey& key,
                             bool hide_no_limb, const PosePool* pool) {
  AugmentedView view = seen_view(raw, fps, placement, settings, key, hide_no_limb, pool);
  if (settings.gravity_deg > 0) misjudge_gravity(view, settings.gravity_deg, key);
  return view;
}

}  // namespace mcdbn
