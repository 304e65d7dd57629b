#pragma once

#include <Eigen/Core>

#include "motion/rotation_vector.hpp"

namespace mcdbn {

/// The matrix that multiplies as v × does.
Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v);

/// How the rotation's own turn follows from a change of the vector: the left Jacobian of SO(3), so
/// that rotation_of(turn + d) is about rotation_of(left_jacobian(turn) · d) · rotation_of(turn).
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& turn_rad);

}  // namespace mcdbn
