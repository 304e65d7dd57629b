#pragma once

#include <ceres/cost_function.h>

#include <Eigen/Core>
#include <vector>

namespace mcdbn {

/// Unknowns of which a normal distribution is known, all of them together:
///   r = U (x − x̂) + r̂        as many numbers of variance 1 as x has
/// x are the blocks, one below the other.
class NormalTerm : public ceres::CostFunction {
 public:
  /// @param factor U  @param at x̂  @param residual r̂  @param sizes of the blocks
  NormalTerm(Eigen::MatrixXd factor, Eigen::VectorXd at, Eigen::VectorXd residual,
             const std::vector<int>& sizes);
  bool Evaluate(double const* const* unknowns, double* residuals,
                double** jacobians) const override;

 private:
  Eigen::MatrixXd factor_;
  Eigen::VectorXd at_, residual_;
};

}  // namespace mcdbn
