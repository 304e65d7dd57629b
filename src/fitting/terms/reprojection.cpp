#include "fitting/terms/reprojection.hpp"

#include <utility>

namespace mcdbn {

Reprojection::Reprojection(JointPlace place, double nearest_m, Eigen::Vector2d ray,
                           double deviation)
    : place_(std::move(place)), nearest_m_(nearest_m), ray_(std::move(ray)), deviation_(deviation) {
  set_num_residuals(2);
  *mutable_parameter_block_sizes() = place_.block_sizes();
}

bool Reprojection::Evaluate(double const* const* unknowns, double* residuals,
                            double** jacobians) const {
  const Eigen::Vector3d x = place_.at(unknowns);
  const bool before_camera = x.z() > nearest_m_;
  Eigen::Map<Eigen::Vector2d> residual(residuals);
  residual.setZero();
  if (before_camera) residual = (x.head<2>() / x.z() - ray_) / deviation_;
  if (!jacobians) return true;
  Eigen::Matrix<double, 2, 3> of_place = Eigen::Matrix<double, 2, 3>::Zero();
  if (before_camera) {
    of_place << 1, 0, -x.x() / x.z(), 0, 1, -x.y() / x.z();
    of_place /= x.z() * deviation_;
  }
  place_.differentiate(of_place, unknowns, jacobians);
  return true;
}

}  // namespace mcdbn
