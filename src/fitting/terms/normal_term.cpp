#include "fitting/terms/normal_term.hpp"

#include <utility>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

NormalTerm::NormalTerm(Eigen::MatrixXd factor, Eigen::VectorXd at, Eigen::VectorXd residual,
                       const std::vector<int>& sizes)
    : factor_(std::move(factor)), at_(std::move(at)), residual_(std::move(residual)) {
  set_num_residuals(static_cast<int>(residual_.size()));
  *mutable_parameter_block_sizes() = sizes;
}

bool NormalTerm::Evaluate(double const* const* unknowns, double* residuals,
                          double** jacobians) const {
  Eigen::VectorXd off = -at_;
  Eigen::Index at = 0;
  const std::vector<int>& sizes = parameter_block_sizes();
  for (std::size_t block = 0; block < sizes.size(); ++block) {
    off.segment(at, sizes[block]) +=
        Eigen::Map<const Eigen::VectorXd>(unknowns[block], sizes[block]);
    if (jacobians && jacobians[block])
      Eigen::Map<MatrixD>(jacobians[block], factor_.rows(), sizes[block]) =
          factor_.middleCols(at, sizes[block]);
    at += sizes[block];
  }
  Eigen::Map<Eigen::VectorXd>(residuals, residual_.size()) = factor_ * off + residual_;
  return true;
}

}  // namespace mcdbn
