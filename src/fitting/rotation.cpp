#include "fitting/rotation.hpp"

#include <cmath>

namespace mcdbn {

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return matrix;
}

Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& turn_rad) {
  const double angle = turn_rad.norm();
  const Eigen::Matrix3d cross = cross_matrix(turn_rad);
  if (angle < 1e-4) return Eigen::Matrix3d::Identity() + 0.5 * cross;
  return Eigen::Matrix3d::Identity() + (1 - std::cos(angle)) / (angle * angle) * cross +
         (angle - std::sin(angle)) / (angle * angle * angle) * cross * cross;
}

}  // namespace mcdbn
