#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace mcdbn {

/// A camera's pitch and roll by where it has up, as Modalities::assumed_camera makes it.
/// @param up against gravity, camera axes
inline double pitch_rad(const Eigen::Vector3d& up) {
  return std::asin(std::clamp(-up.z(), -1.0, 1.0));
}
inline double roll_rad(const Eigen::Vector3d& up) {
  return std::atan2(-up.x(), -up.y());
}

}  // namespace mcdbn
