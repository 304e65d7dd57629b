#include "fitting/terms/camera_lean.hpp"

#include <Eigen/Core>

namespace mcdbn {

bool CameraLean::Evaluate(double const* const* unknowns, double* residuals,
                          double** jacobians) const {
  const Eigen::Map<const Eigen::Vector3d> lean(unknowns[0]);
  residuals[0] = (right_.dot(lean) - expected_.pitch) / expected_.pitch_deviation;
  residuals[1] = (-lean.z() - expected_.roll) / expected_.roll_deviation;
  if (!jacobians || !jacobians[0]) return true;
  Eigen::Map<Eigen::Matrix<double, 2, 3, Eigen::RowMajor>> derivatives(jacobians[0]);
  derivatives.setZero();
  derivatives.row(0) = right_.transpose() / expected_.pitch_deviation;
  derivatives(1, 2) = -1 / expected_.roll_deviation;
  return true;
}

}  // namespace mcdbn
