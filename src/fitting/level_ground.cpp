#include "fitting/level_ground.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/upper_median.hpp"
#include "motion/body_size.hpp"
#include "motion/foot_joints.hpp"

namespace mcdbn {
namespace {

using Eigen::ArrayXd;
using Eigen::Vector3d;

constexpr double kDegree = EIGEN_PI / 180;

/// A clip along the camera's own level axes, metres.
struct Footing {
  Vector3d ahead, aside;                ///< level: away from the camera, and to its right
  ArrayXd along, across, height;        ///< of the lower foot in each frame, about their mean
  double balance_ahead, balance_aside;  ///< rise of what the body stands upright on
  double ray_falls;                     ///< of the ray to the feet, for each metre ahead
  double witnesses;
};

Footing footing_of(const FittedClip& clip, double witness_s) {
  Footing footing;
  const Eigen::Matrix3d world_from_camera = clip.camera.camera_from_world.transpose();
  footing.ahead = world_from_camera.col(2);
  footing.ahead.y() = 0;
  footing.ahead.normalize();
  footing.aside = footing.ahead.cross(Vector3d::UnitY());
  const Vector3d centre = -world_from_camera * clip.camera.translation;
  const MatrixD positions =
      joint_positions(clip.motion) / file_units_per_metre(clip.motion.skeleton);
  const std::vector<int> feet = foot_joints(clip.motion.skeleton);
  const Eigen::Index frames = positions.rows(), joints = positions.cols() / 3;
  footing.along.resize(frames);
  footing.across.resize(frames);
  footing.height.resize(frames);
  Vector3d upright = Vector3d::Zero();
  for (Eigen::Index t = 0; t < frames; ++t) {
    Vector3d lowest(0, std::numeric_limits<double>::infinity(), 0), middle = Vector3d::Zero();
    for (const int foot : feet) {
      const Vector3d at = positions.row(t).segment<3>(3 * foot).transpose();
      middle += at / static_cast<double>(feet.size());
      if (at.y() < lowest.y()) lowest = at;
    }
    for (Eigen::Index joint = 0; joint < joints; ++joint)
      upright += positions.row(t).segment<3>(3 * joint).transpose() / static_cast<double>(joints);
    upright -= middle;
    footing.along[t] = lowest.dot(footing.ahead);
    footing.across[t] = lowest.dot(footing.aside);
    footing.height[t] = lowest.y();
  }
  const Vector3d seen_from = centre / file_units_per_metre(clip.motion.skeleton);
  footing.ray_falls = (seen_from.y() - footing.height.mean()) /
                      std::max(1e-3, footing.along.mean() - seen_from.dot(footing.ahead));
  for (ArrayXd* values : {&footing.along, &footing.across, &footing.height})
    *values -= values->mean();
  footing.balance_ahead = -upright.dot(footing.ahead) / upright.y();
  footing.balance_aside = -upright.dot(footing.aside) / upright.y();
  footing.witnesses =
      std::max(1.0, static_cast<double>(frames) * clip.motion.frame_time_s / witness_s);
  return footing;
}

double squared(double x) {
  return x * x;
}

/// Heights above ground that rises so.
ArrayXd above(const Footing& footing, double rise) {
  const ArrayXd heights = footing.height - rise * footing.along;
  return heights - upper_median({heights.begin(), heights.end()});
}

/// Variance of those heights: of the foot itself, and of a distance that is off along the ray.
double variance(const Footing& footing, double rise, const LevelGroundSettings& settings) {
  return squared(settings.height_m) + squared(settings.depth_m * (footing.ray_falls + rise));
}

/// -ln of how likely ground is that rises away from the camera by that angle. Heights are Cauchy:
/// who jumps has no foot on the ground.
double energy(const Footing& footing, double rise_rad, double pitch_rad,
              const LevelGroundSettings& settings) {
  const double rise = std::tan(rise_rad), spread = variance(footing, rise, settings);
  const double heights =
      (above(footing, rise).square() / spread).log1p().mean() + 0.5 * std::log(spread);
  return footing.witnesses * heights +
         0.5 * squared((pitch_rad + rise_rad) / (settings.pitch_deg * kDegree)) +
         0.5 * squared((rise_rad - std::atan(footing.balance_ahead)) /
                       (settings.balance_deg * kDegree));
}

double likeliest_rise_rad(const Footing& footing, double pitch_rad,
                          const LevelGroundSettings& settings) {
  constexpr int kSteps = 160;
  constexpr double kStep = kDegree / 4;
  double best = 0, least = std::numeric_limits<double>::infinity();
  for (int step = -kSteps; step <= kSteps; ++step)
    if (const double e = energy(footing, step * kStep, pitch_rad, settings); e < least) {
      least = e;
      best = step * kStep;
    }
  return best;
}

/// Small, so that a line will do: least squares, heights weighted as Cauchy has them.
double likeliest_tilt_rad(const Footing& footing, double rise_rad, double roll_rad,
                          const LevelGroundSettings& settings) {
  const double rise = std::tan(rise_rad), spread = variance(footing, rise, settings);
  const ArrayXd heights = above(footing, rise);
  const ArrayXd weights = footing.witnesses / static_cast<double>(heights.size()) /
                          (spread * (1 + heights.square() / spread));
  const double prior = 1 / squared(settings.roll_deg * kDegree),
               balance = 1 / squared(settings.balance_deg * kDegree);
  return ((weights * footing.across * heights).sum() - prior * roll_rad +
          balance * footing.balance_aside) /
         ((weights * footing.across.square()).sum() + prior + balance);
}

/// A camera's pitch and roll by where it has up, as Modalities::assumed_camera makes it.
double pitch_rad(const Vector3d& up_in_camera) {
  return std::asin(std::clamp(-up_in_camera.z(), -1.0, 1.0));
}
double roll_rad(const Vector3d& up_in_camera) {
  return std::atan2(-up_in_camera.x(), -up_in_camera.y());
}

}  // namespace

AssumedView levelled_view(const AssumedView& said, const FittedClip& clip,
                          const LevelGroundSettings& settings) {
  AssumedView view = said;
  if (foot_joints(clip.motion.skeleton).empty()) return view;
  const Footing footing = footing_of(clip, settings.witness_s);
  const Eigen::Matrix3d& camera_from_world = clip.camera.camera_from_world;
  const Vector3d up_now = camera_from_world.col(1);
  const double rise = said.pitch_deg ? 0 : likeliest_rise_rad(footing, pitch_rad(up_now), settings);
  const double tilt =
      said.roll_deg ? 0 : likeliest_tilt_rad(footing, rise, roll_rad(up_now), settings);
  const Vector3d up = camera_from_world * (Vector3d::UnitY() - std::tan(rise) * footing.ahead -
                                           std::tan(tilt) * footing.aside)
                                              .normalized();
  constexpr double kSteepest_deg = AssumedView::kPitch_deg.most;
  if (!said.pitch_deg)
    view.pitch_deg = std::clamp(pitch_rad(up) / kDegree, -kSteepest_deg, kSteepest_deg);
  if (!said.roll_deg) view.roll_deg = roll_rad(up) / kDegree;
  return view;
}

}  // namespace mcdbn
