#include "fitting/terms/reprojection.hpp"

#include <cmath>
#include <utility>

namespace mcdbn {

Reprojection::Reprojection(JointPlace place, double nearest_m, Eigen::Vector2d ray,
                           double deviation, bool camera_unknown)
    : place_(std::move(place)),
      nearest_m_(nearest_m),
      ray_(std::move(ray)),
      deviation_(deviation),
      camera_unknown_(camera_unknown) {
  set_num_residuals(2);
  *mutable_parameter_block_sizes() = place_.block_sizes();
  if (camera_unknown_) mutable_parameter_block_sizes()->push_back(1);
}

bool Reprojection::Evaluate(double const* const* unknowns, double* residuals,
                            double** jacobians) const {
  const Eigen::Vector3d x = place_.at(unknowns);
  const bool before_camera = x.z() > nearest_m_;
  const int focal = place_.blocks();
  const double magnified = camera_unknown_ ? std::exp(unknowns[focal][0]) : 1;
  Eigen::Map<Eigen::Vector2d> residual(residuals);
  residual.setZero();
  if (before_camera) residual = (magnified * x.head<2>() / x.z() - ray_) / deviation_;
  if (!jacobians) return true;
  Eigen::Matrix<double, 2, 3> of_place = Eigen::Matrix<double, 2, 3>::Zero();
  if (before_camera) {
    of_place << 1, 0, -x.x() / x.z(), 0, 1, -x.y() / x.z();
    of_place *= magnified / (x.z() * deviation_);
  }
  place_.differentiate(of_place, unknowns, jacobians);
  if (camera_unknown_ && jacobians[focal]) {
    Eigen::Map<Eigen::Vector2d> of_focal(jacobians[focal]);
    of_focal.setZero();
    if (before_camera) of_focal = magnified * x.head<2>() / (x.z() * deviation_);
  }
  return true;
}

}  // namespace mcdbn
