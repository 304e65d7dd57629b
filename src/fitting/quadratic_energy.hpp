#pragma once

#include <ceres/problem.h>

#include <Eigen/Core>
#include <unordered_map>
#include <vector>

#include "fitting/marginal_prior.hpp"

namespace mcdbn {

/// One of Ceres' blocks of unknowns.
struct UnknownBlock {
  double* unknown;
  int size;
};

/// Terms of a problem near the point where it is, as a normal distribution of some of its unknowns:
/// their energy is ½ dᵀ H d + gᵀ d + …, d the step from there, the losses as they weigh there.
class QuadraticEnergy {
 public:
  explicit QuadraticEnergy(const std::vector<UnknownBlock>& unknowns);

  /// @param term whose other unknowns stay as they are
  void add(const ceres::Problem& problem, ceres::ResidualBlockId term);

  /// The energy of the other numbers when the first `numbers` take their likeliest values given
  /// them: H₂₂ − H₂₁ H₁₁⁻¹ H₁₂ and g₂ − H₂₁ H₁₁⁻¹ g₁, as a sum of squares.
  MarginalPrior without_first(Eigen::Index numbers) const;

 private:
  std::unordered_map<double*, Eigen::Index> columns_;
  Eigen::VectorXd at_, gradient_;
  Eigen::MatrixXd hessian_;
};

}  // namespace mcdbn
