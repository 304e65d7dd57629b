#include "fitting/length_information.hpp"

#include <Eigen/SparseCholesky>

namespace mcdbn {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// Deviation of what no residual tells of, radians and metres: so that there is a factor.
constexpr double kUntold = 10;

}  // namespace

Eigen::MatrixXd information_on_lengths(const Sparse& derivatives, Eigen::Index lengths) {
  const Eigen::Index rest = derivatives.cols() - lengths;
  const Sparse all = derivatives.transpose() * derivatives;
  Sparse untold(rest, rest);
  untold.setIdentity();
  const Sparse own = Sparse(all.topLeftCorner(rest, rest)) + untold / (kUntold * kUntold);
  const Eigen::SimplicialLDLT<Sparse> factor(own);
  if (factor.info() != Eigen::Success) return Eigen::MatrixXd::Zero(lengths, lengths);
  const Eigen::MatrixXd between = Sparse(all.topRightCorner(rest, lengths));
  const Eigen::MatrixXd information =
      Eigen::MatrixXd(Sparse(all.bottomRightCorner(lengths, lengths))) -
      between.transpose() * factor.solve(between);
  return (information + information.transpose()) / 2;
}

}  // namespace mcdbn
