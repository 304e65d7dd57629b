#pragma once

#include <Eigen/Core>

namespace mcdbn {

/// Rotation by the vector's length (radians) about it.
Eigen::Matrix3d rotation_of(const Eigen::Vector3d& turn_rad);

/// The vector of length 0 to π that rotation_of makes it from.
Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& rotation);

}  // namespace mcdbn
