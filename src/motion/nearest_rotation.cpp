#include "motion/nearest_rotation.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>

namespace mcdbn {

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double mirror = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  return svd.matrixU() * Eigen::Vector3d(1, 1, mirror).asDiagonal() * svd.matrixV().transpose();
}

}  // namespace mcdbn
