#pragma once

#include <Eigen/Core>

namespace mcdbn {

/// The prior from frames that are not solved any more for those after them: a normal distribution,
/// marginalized over their own unknowns by the Schur complement; what all frames share is as it
/// was. Its energy is ½ |factor · (x − at) + residual|². x is, of each of kReach frames, its turns
/// and the place of its root.
struct MarginalPrior {
  /// A frame has terms in common with so many after it: how orientations bend.
  static constexpr Eigen::Index kReach = 2;

  Eigen::MatrixXd factor;
  Eigen::VectorXd at, residual;
};

}  // namespace mcdbn
