#pragma once

#include <ceres/cost_function.h>

#include "fitting/terms/joint_place.hpp"

namespace mcdbn {

/// A joint lies on the ray that the camera saw it along:
///   r = (exp(focal) · (x/z, y/z) − ray) / deviation       two numbers of variance 1
/// where focal is, if the camera is unknown, one more block (1): the logarithm of the camera's
/// focal length over the one that ray and deviation were made with; else 0. Nearer to the camera
/// than nearest_m, or behind it, a joint is seen as if it were so near: else whole bodies would be
/// likeliest where all residuals are 0, behind the camera.
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
