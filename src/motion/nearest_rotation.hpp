#pragma once

#include <Eigen/Core>

namespace mcdbn {

/// The rotation that is nearest to a matrix, as the squares of their differences have it: of
/// Σ target·sourceᵀ the one that brings `source` nearest to `target` (Kabsch 1976).
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix);

}  // namespace mcdbn
