#pragma once

#include <ceres/cost_function.h>

#include "fitting/terms/joint_place.hpp"

namespace mcdbn {

/// A joint lies on the ray that the camera saw it along:
///   r = ((x/z, y/z) − ray) / deviation       two numbers of variance 1
/// A joint nearer to the camera than a tenth of the root's first depth says nothing.
class Reprojection : public ceres::CostFunction {
 public:
  /// @param ray x/z and y/z, lens taken out  @param deviation of each of both, in the same unit
  Reprojection(JointPlace place, double nearest_m, Eigen::Vector2d ray, double deviation);
  bool Evaluate(double const* const* unknowns, double* residuals,
                double** jacobians) const override;

 private:
  JointPlace place_;
  double nearest_m_;
  Eigen::Vector2d ray_;
  double deviation_;
};

}  // namespace mcdbn
