#pragma once

#include <ceres/cost_function.h>

#include <Eigen/Core>

namespace mcdbn {

/// A body of which earlier frames tell:
///   r = Uᵀ (λ − λ̂)       U Uᵀ their information on λ, as many numbers as there are lengths
/// Blocks: the logarithms of the lengths, one each.
class ToldLengths : public ceres::CostFunction {
 public:
  /// @param information symmetric, not negative [lengths x lengths]
  ToldLengths(Eigen::VectorXd log_lengths, const Eigen::MatrixXd& information);
  bool Evaluate(double const* const* unknowns, double* residuals,
                double** jacobians) const override;

 private:
  Eigen::VectorXd log_lengths_;
  Eigen::MatrixXd root_;  ///< Uᵀ
};

}  // namespace mcdbn
