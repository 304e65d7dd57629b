#include "fitting/quadratic_energy.hpp"

#include <ceres/cost_function.h>
#include <ceres/loss_function.h>

#include <Eigen/Cholesky>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

QuadraticEnergy::QuadraticEnergy(const std::vector<UnknownBlock>& unknowns) {
  Eigen::Index size = 0;
  for (const UnknownBlock& block : unknowns) {
    columns_[block.unknown] = size;
    size += block.size;
  }
  at_.resize(size);
  for (const UnknownBlock& block : unknowns)
    at_.segment(columns_[block.unknown], block.size) =
        Eigen::Map<const Eigen::VectorXd>(block.unknown, block.size);
  gradient_ = Eigen::VectorXd::Zero(size);
  hessian_ = Eigen::MatrixXd::Zero(size, size);
}

void QuadraticEnergy::add(const ceres::Problem& problem, ceres::ResidualBlockId term) {
  const ceres::CostFunction* const cost = problem.GetCostFunctionForResidualBlock(term);
  const ceres::LossFunction* const loss = problem.GetLossFunctionForResidualBlock(term);
  std::vector<double*> unknowns;
  problem.GetParameterBlocksForResidualBlock(term, &unknowns);
  Eigen::VectorXd residual(cost->num_residuals());
  std::vector<MatrixD> derivatives;
  for (const int size : cost->parameter_block_sizes())
    derivatives.emplace_back(cost->num_residuals(), size);
  std::vector<double*> places;
  places.reserve(derivatives.size());
  for (MatrixD& derivative : derivatives) places.push_back(derivative.data());
  cost->Evaluate(unknowns.data(), residual.data(), places.data());
  double rho[3] = {0, 1, 0};
  if (loss) loss->Evaluate(residual.squaredNorm(), rho);
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const auto row = columns_.find(unknowns[i]);
    if (row == columns_.end()) continue;
    const Eigen::Index size = derivatives[i].cols();
    gradient_.segment(row->second, size) += rho[1] * derivatives[i].transpose() * residual;
    for (std::size_t j = 0; j < unknowns.size(); ++j) {
      const auto column = columns_.find(unknowns[j]);
      if (column == columns_.end()) continue;
      hessian_.block(row->second, column->second, size, derivatives[j].cols()) +=
          rho[1] * derivatives[i].transpose() * derivatives[j];
    }
  }
}

MarginalPrior QuadraticEnergy::without_first(Eigen::Index numbers) const {
  const Eigen::Index rest = at_.size() - numbers;
  const Eigen::LDLT<Eigen::MatrixXd> first(hessian_.topLeftCorner(numbers, numbers));
  const Eigen::MatrixXd across = first.solve(hessian_.topRightCorner(numbers, rest));
  const Eigen::MatrixXd hessian =
      hessian_.bottomRightCorner(rest, rest) - hessian_.bottomLeftCorner(rest, numbers) * across;
  const Eigen::VectorXd gradient =
      gradient_.tail(rest) - across.transpose() * gradient_.head(numbers);
  // H = Pᵀ L D Lᵀ P, where what no term determines has 0 in D, or a little less.
  const Eigen::LDLT<Eigen::MatrixXd> factors((hessian + hessian.transpose()) / 2);
  const Eigen::VectorXd root = factors.vectorD().cwiseMax(0).cwiseSqrt();
  MarginalPrior left;
  left.at = at_.tail(rest);
  const Eigen::MatrixXd lower = factors.matrixL();
  // Eigen puts transpositions on a product's right in the wrong order: they stand on the left.
  left.factor = (factors.transpositionsP().transpose() * (lower * root.asDiagonal())).transpose();
  left.residual = factors.matrixL().solve(Eigen::VectorXd(factors.transpositionsP() * gradient));
  const double least = 1e-9 * root.maxCoeff();
  for (Eigen::Index i = 0; i < rest; ++i)
    left.residual[i] = root[i] > least ? left.residual[i] / root[i] : 0;
  return left;
}

}  // namespace mcdbn
