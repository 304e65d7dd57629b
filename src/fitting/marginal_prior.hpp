#pragma once

#include <Eigen/Core>

namespace mcdbn {

/// What frames that are not solved any more say of those after them, and of what all frames share:
/// a normal distribution, marginalized over their own unknowns by the Schur complement. Its energy
/// is ½ |factor · (x − at) + residual|². x is, of each of kReach frames, its turns and the place of
/// its root; then, as far as they are unknown, lengths, heights of the ground, the camera's lean
/// and its focal length (PosteriorPoint).
struct MarginalPrior {
  /// A frame says something of so many behind it: how orientations bend.
  static constexpr Eigen::Index kReach = 2;

  Eigen::MatrixXd factor;
  Eigen::VectorXd at, residual;
};

}  // namespace mcdbn
