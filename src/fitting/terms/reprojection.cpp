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
  const bool near = !(x.z() > nearest_m_);
  const double depth = near ? nearest_m_ * nearest_m_ / (2 * nearest_m_ - x.z()) : x.z();
  const double depth_of_z = near ? depth * depth / (nearest_m_ * nearest_m_) : 1;
  const int focal = place_.blocks();
  const double magnified = camera_unknown_ ? std::exp(unknowns[focal][0]) : 1;
  const Eigen::Vector2d shown = magnified * x.head<2>() / depth;
  Eigen::Map<Eigen::Vector2d>{residuals} = (shown - ray_) / deviation_;
  if (!jacobians) return true;
  Eigen::Matrix<double, 2, 3> of_place;
  of_place << Eigen::Matrix2d::Identity(), -depth_of_z / depth * x.head<2>();
  of_place *= magnified / (depth * deviation_);
  place_.differentiate(of_place, unknowns, jacobians);
  if (camera_unknown_ && jacobians[focal])
    Eigen::Map<Eigen::Vector2d>{jacobians[focal]} = shown / deviation_;
  return true;
}

}  // namespace mcdbn
