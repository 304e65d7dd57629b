#pragma once

#include <Eigen/Core>

namespace mcdbn {

/// Rotation by the vector's length (radians) about it.
Eigen::Matrix3d rotation_of(const Eigen::Vector3d& turn_rad);

}  // namespace mcdbn
