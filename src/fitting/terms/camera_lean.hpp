#pragma once

#include <ceres/sized_cost_function.h>

#include <utility>

#include "fitting/unknown_camera.hpp"

namespace mcdbn {

/// r = (right · lean − pitch) / deviation, (−lean_z − roll) / deviation      two numbers of
/// variance 1 of one block (3): the turn of the world about the camera's axes, radians.
class CameraLean : public ceres::SizedCostFunction<2, 3> {
 public:
  /// @param right level, of unit length, camera axes
  CameraLean(const ExpectedLean& expected, Eigen::Vector3d right)
      : expected_(expected), right_(std::move(right)) {}
  bool Evaluate(double const* const* unknowns, double* residuals,
                double** jacobians) const override;

 private:
  ExpectedLean expected_;
  Eigen::Vector3d right_;
};

}  // namespace mcdbn
