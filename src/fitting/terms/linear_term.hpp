#pragma once

#include <ceres/cost_function.h>

#include <Eigen/Core>
#include <vector>

namespace mcdbn {

/// A weighted sum of unknown vectors that is expected to be near a number:
///   r = (Σ share_i · block_i − expected) / deviation       as many numbers as a block has
/// of which priors, differences over time and differences along the tree of joints are made.
class LinearTerm : public ceres::CostFunction {
 public:
  /// @param shares by block  @param expected its size is that of every block
  LinearTerm(std::vector<double> shares, Eigen::VectorXd expected, double deviation);
  bool Evaluate(double const* const* unknowns, double* residuals,
                double** jacobians) const override;

 private:
  std::vector<double> shares_;
  Eigen::VectorXd expected_;
  double deviation_;
};

}  // namespace mcdbn
