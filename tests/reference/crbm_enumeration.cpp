#include "reference/crbm_enumeration.hpp"

#include <cmath>
#include <numbers>

#include "reference/units_reference.hpp"

namespace mcdbn::reference {
namespace {

/// log ∫ exp(−E(v, h)) dv for each hidden state h, with E of eq 14 (eq 2 for binary units).
Eigen::VectorXd log_weights(const Crbm& model, const MatrixD& states, const RowVectorD& a,
                            const RowVectorD& b) {
  const MatrixD top_down = states * model.weights.transpose();
  Eigen::VectorXd result = states * b.transpose();
  for (Eigen::Index s = 0; s < states.rows(); ++s) {
    if (model.visible_units == VisibleUnits::gaussian)
      result(s) += 0.5 * top_down.row(s).squaredNorm() + top_down.row(s).dot(a) +
                   0.5 * static_cast<double>(a.size()) * std::log(2.0 * std::numbers::pi);
    else
      result(s) += softplus(top_down.row(s) + a).sum();
  }
  return result;
}

double log_sum_exp(const Eigen::VectorXd& x) {
  const double largest = x.maxCoeff();
  return largest + std::log((x.array() - largest).exp().sum());
}

/// The same for each hidden state under one history [1 x n·D].
Eigen::VectorXd log_weights(const Crbm& model, const MatrixD& history) {
  return log_weights(model, all_states(model.hidden_bias.size()),
                     dynamic_visible_bias(model, history), dynamic_hidden_bias(model, history));
}

}  // namespace

MatrixD all_states(Eigen::Index units) {
  const Eigen::Index count = Eigen::Index{1} << units;
  MatrixD states(count, units);
  for (Eigen::Index s = 0; s < count; ++s)
    for (Eigen::Index j = 0; j < units; ++j) states(s, j) = static_cast<double>((s >> j) & 1);
  return states;
}

MatrixD free_energy(const Crbm& model, const CrbmBatch& batch) {
  const MatrixD visible_bias = dynamic_visible_bias(model, batch.history);
  const MatrixD input = dynamic_hidden_bias(model, batch.history) + batch.visible * model.weights;
  const MatrixD seen = model.visible_units == VisibleUnits::gaussian
                           ? MatrixD(0.5 * (batch.visible - visible_bias).cwiseAbs2())
                           : MatrixD(-batch.visible.cwiseProduct(visible_bias));
  return seen.rowwise().sum() - softplus(input).rowwise().sum();
}

Eigen::VectorXd log_partition(const Crbm& model, const MatrixD& history) {
  Eigen::VectorXd result(history.rows());
  for (Eigen::Index r = 0; r < history.rows(); ++r)
    result(r) = log_sum_exp(log_weights(model, history.row(r)));
  return result;
}

Eigen::VectorXd hidden_distribution(const Crbm& model, const MatrixD& history) {
  const Eigen::VectorXd logs = log_weights(model, history);
  return (logs.array() - log_sum_exp(logs)).exp();
}

Eigen::VectorXd visible_distribution(const Crbm& model, const MatrixD& history) {
  const MatrixD states = all_states(model.visible_bias.size());
  const MatrixD energy = free_energy(model, {states, history.replicate(states.rows(), 1)});
  return (-energy.col(0).array() - log_partition(model, history)(0)).exp();
}

double log_likelihood(const Crbm& model, const CrbmBatch& batch) {
  return (-free_energy(model, batch).col(0) - log_partition(model, batch.history)).mean();
}

Crbm expected_statistics(const Crbm& model, const MatrixD& history) {
  const MatrixD states = all_states(model.hidden_bias.size());
  Crbm expected = model.with_parameters(Eigen::VectorXd::Zero(model.flattened().size()));
  for (Eigen::Index r = 0; r < history.rows(); ++r) {
    const Eigen::VectorXd probability = hidden_distribution(model, history.row(r));
    const MatrixD visible_bias = dynamic_visible_bias(model, history.row(r));
    const MatrixD means = visible_mean(model, states, visible_bias.replicate(states.rows(), 1));
    const MatrixD weighted_means = probability.asDiagonal() * means;
    const RowVectorD v = weighted_means.colwise().sum();
    const RowVectorD h = probability.transpose() * states;
    expected.weights += weighted_means.transpose() * states;
    expected.visible_history += history.row(r).tail(model.visible_history.rows()).transpose() * v;
    expected.hidden_history += history.row(r).tail(model.hidden_history.rows()).transpose() * h;
    expected.visible_bias += v;
    expected.hidden_bias += h;
  }
  return expected;
}

Crbm exact_gradient(const Crbm& model, const CrbmBatch& batch) {
  const MatrixD hidden =
      hidden_probability(model, batch.visible, dynamic_hidden_bias(model, batch.history));
  const Crbm data = statistics(model, batch, batch.visible, hidden);
  const Crbm expected = expected_statistics(model, batch.history);
  return model.with_parameters((data.flattened() - expected.flattened()) /
                               static_cast<double>(batch.visible.rows()));
}

}  // namespace mcdbn::reference
