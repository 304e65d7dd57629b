#pragma once

#include <ceres/cost_function.h>

#include "fitting/terms/joint_place.hpp"

namespace mcdbn {

/// A joint that stands is as high as the ground is under such joints:
///   r = (R(lean) up · x − above) / deviation        one number of variance 1, deviation in metres
/// Blocks: those of the joint's place; how high, above the camera (1, m); and, if the camera is
/// unknown, how it leans otherwise than assumed (3, radians).
class GroundContact : public ceres::CostFunction {
 public:
  /// @param up against gravity, camera axes, as assumed
  GroundContact(JointPlace place, Eigen::Vector3d up, double deviation_m, bool camera_unknown);
  bool Evaluate(double const* const* unknowns, double* residuals,
                double** jacobians) const override;

 private:
  JointPlace place_;
  Eigen::Vector3d up_;
  double deviation_m_;
  bool camera_unknown_;
};

}  // namespace mcdbn
