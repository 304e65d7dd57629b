#pragma once

#include <ceres/cost_function.h>

#include "fitting/terms/joint_place.hpp"

namespace mcdbn {

/// A joint that stands is where it was a frame before:
///   r = (x(t) − x(t−1)) / deviation       three numbers of variance 1, deviation in metres
/// Blocks: the turns and the shift of the frame before, those of the frame, then, if the body is
/// unknown, the lengths, which are both frames'.
class StandingFoot : public ceres::CostFunction {
 public:
  StandingFoot(JointPlace before, JointPlace after, double deviation_m);
  bool Evaluate(double const* const* unknowns, double* residuals,
                double** jacobians) const override;

 private:
  int moving_blocks() const;  ///< of one frame

  JointPlace before_, after_;
  double deviation_m_;
};

}  // namespace mcdbn
