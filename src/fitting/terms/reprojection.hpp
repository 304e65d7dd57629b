#pragma once

#include <ceres/cost_function.h>

#include "fitting/terms/joint_place.hpp"

namespace mcdbn {

/// A joint lies on the ray that the camera saw it along:
///   r = (exp(focal) · (x/z, y/z) − ray) / deviation       two numbers of variance 1
/// where focal is, if the camera is unknown, one more block (1): the logarithm of the camera's
/// focal length over the one that ray and deviation were made with; else 0. A joint nearer to the
/// camera than nearest_m, n, or behind it, is seen as if at the depth n² / (2·n − z), which goes on
/// smoothly from z and stays above 0: the further behind, the further off it is seen. As if at one
/// depth, bodies behind the camera would be likely that are long along the view and thin across.
class Reprojection : public ceres::CostFunction {
 public:
  /// @param ray x/z and y/z, lens taken out  @param deviation of each of both, in the same unit
  Reprojection(JointPlace place, double nearest_m, Eigen::Vector2d ray, double deviation,
               bool camera_unknown = false);
  bool Evaluate(double const* const* unknowns, double* residuals,
                double** jacobians) const override;

 private:
  JointPlace place_;
  double nearest_m_;
  Eigen::Vector2d ray_;
  double deviation_;
  bool camera_unknown_;
};

}  // namespace mcdbn
