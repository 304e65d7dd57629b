#pragma once

#include <ceres/sized_cost_function.h>

#include "fitting/camera_doubt.hpp"

namespace mcdbn {

/// r = (lean_x − pitch) / deviation, (−lean_z − roll) / deviation      two numbers of variance 1
/// of one block (3): the turn of the world about the camera's axes, radians.
class CameraLean : public ceres::SizedCostFunction<2, 3> {
 public:
  explicit CameraLean(const ExpectedLean& expected) : expected_(expected) {}
  bool Evaluate(double const* const* unknowns, double* residuals,
                double** jacobians) const override;

 private:
  ExpectedLean expected_;
};

}  // namespace mcdbn
