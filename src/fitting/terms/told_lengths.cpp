#include "fitting/terms/told_lengths.hpp"

#include <Eigen/Eigenvalues>
#include <utility>

namespace mcdbn {

ToldLengths::ToldLengths(Eigen::VectorXd log_lengths, const Eigen::MatrixXd& information)
    : log_lengths_(std::move(log_lengths)) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(information);
  root_ =
      parts.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() * parts.eigenvectors().transpose();
  set_num_residuals(static_cast<int>(root_.rows()));
  mutable_parameter_block_sizes()->assign(static_cast<std::size_t>(root_.cols()), 1);
}

bool ToldLengths::Evaluate(double const* const* unknowns, double* residuals,
                           double** jacobians) const {
  Eigen::VectorXd off = -log_lengths_;
  for (Eigen::Index i = 0; i < off.size(); ++i) off[i] += unknowns[i][0];
  Eigen::Map<Eigen::VectorXd>(residuals, off.size()) = root_ * off;
  if (!jacobians) return true;
  for (Eigen::Index i = 0; i < off.size(); ++i)
    if (jacobians[i]) Eigen::Map<Eigen::VectorXd>(jacobians[i], off.size()) = root_.col(i);
  return true;
}

}  // namespace mcdbn
