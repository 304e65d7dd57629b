#include "fitting/terms/camera_lean.hpp"

#include <Eigen/Core>

namespace mcdbn {

bool CameraLean::Evaluate(double const* const* unknowns, double* residuals,
                          double** jacobians) const {
  residuals[0] = (unknowns[0][0] - expected_.pitch) / expected_.pitch_deviation;
  residuals[1] = (-unknowns[0][2] - expected_.roll) / expected_.roll_deviation;
  if (!jacobians || !jacobians[0]) return true;
  Eigen::Map<Eigen::Matrix<double, 2, 3, Eigen::RowMajor>> derivatives(jacobians[0]);
  derivatives.setZero();
  derivatives(0, 0) = 1 / expected_.pitch_deviation;
  derivatives(1, 2) = -1 / expected_.roll_deviation;
  return true;
}

}  // namespace mcdbn
