#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace mcdbn {

/// A camera's pitch and roll by where it has up, as Modalities::assumed_camera makes it.
/// @param up against gravity, camera axes
inline double pitch_rad(const Eigen::Vector3d& up) {
  return std::asin(std::clamp(-up.z(), -1.0, 1.0));
}
inline double roll_rad(const Eigen::Vector3d& up) {
  return std::atan2(-up.x(), -up.y());
}
/// Difference of two cameras' rolls, the short way round.
inline double roll_from_to_rad(const Eigen::Vector3d& from_up, const Eigen::Vector3d& to_up) {
  return std::remainder(roll_rad(to_up) - roll_rad(from_up), 2 * std::numbers::pi);
}

/// The level direction to the right of the view, camera axes: to pitch is to turn about it. Where
/// the camera looks straight up or down any is level.
inline Eigen::Vector3d level_right(const Eigen::Vector3d& up) {
  const Eigen::Vector3d across(-up.y(), up.x(), 0);
  return across.norm() > 1e-6 ? Eigen::Vector3d(across.normalized()) : Eigen::Vector3d::UnitX();
}

}  // namespace mcdbn
