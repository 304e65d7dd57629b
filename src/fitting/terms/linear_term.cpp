#include "fitting/terms/linear_term.hpp"

#include <utility>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

LinearTerm::LinearTerm(std::vector<double> shares, Eigen::VectorXd expected, double deviation)
    : shares_(std::move(shares)), expected_(std::move(expected)), deviation_(deviation) {
  set_num_residuals(static_cast<int>(expected_.size()));
  mutable_parameter_block_sizes()->assign(shares_.size(), static_cast<int>(expected_.size()));
}

bool LinearTerm::Evaluate(double const* const* unknowns, double* residuals,
                          double** jacobians) const {
  const Eigen::Index size = expected_.size();
  Eigen::Map<Eigen::VectorXd> residual(residuals, size);
  residual = -expected_;
  for (std::size_t i = 0; i < shares_.size(); ++i)
    residual += shares_[i] * Eigen::Map<const Eigen::VectorXd>(unknowns[i], size);
  residual /= deviation_;
  if (!jacobians) return true;
  for (std::size_t i = 0; i < shares_.size(); ++i)
    if (jacobians[i])
      Eigen::Map<MatrixD>(jacobians[i], size, size) =
          shares_[i] / deviation_ * MatrixD::Identity(size, size);
  return true;
}

}  // namespace mcdbn
