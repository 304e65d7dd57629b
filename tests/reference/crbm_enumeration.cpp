#include "reference/crbm_enumeration.hpp"

#include <cmath>
#include <numbers>

#include "reference/units_reference.hpp"

namespace mcdbn::reference {
namespace {

/// Every hidden state, one a row: [2^H x H].
MatrixD all_states(Eigen::Index hidden) {
  const Eigen::Index count = Eigen::Index{1} << hidden;
  MatrixD states(count, hidden);
  for (Eigen::Index s = 0; s < count; ++s)
    for (Eigen::Index j = 0; j < hidden; ++j) states(s, j) = static_cast<double>((s >> j) & 1);
  return states;
}

double softplus(double x) {
  return std::max(x, 0.0) + std::log1p(std::exp(-std::abs(x)));
}

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
      for (Eigen::Index i = 0; i < a.size(); ++i) result(s) += softplus(top_down(s, i) + a(i));
  }
  return result;
}

double log_sum_exp(const Eigen::VectorXd& x) {
  const double largest = x.maxCoeff();
  return largest + std::log((x.array() - largest).exp().sum());
}

}  // namespace

double log_likelihood(const Crbm& model, const CrbmBatch& batch) {
  const MatrixD states = all_states(model.hidden_bias.size());
  const MatrixD visible_bias = dynamic_visible_bias(model, batch.history);
  const MatrixD hidden_bias = dynamic_hidden_bias(model, batch.history);
  double sum = 0;
  for (Eigen::Index r = 0; r < batch.visible.rows(); ++r) {
    const RowVectorD v = batch.visible.row(r);
    const RowVectorD input = hidden_bias.row(r) + v * model.weights;
    double log_unnormalized = 0;  // log Σ_h exp(−E(v, h))
    for (Eigen::Index j = 0; j < input.size(); ++j) log_unnormalized += softplus(input(j));
    log_unnormalized += model.visible_units == VisibleUnits::gaussian
                            ? -0.5 * (v - visible_bias.row(r)).squaredNorm()
                            : v.dot(visible_bias.row(r));
    sum += log_unnormalized -
           log_sum_exp(log_weights(model, states, visible_bias.row(r), hidden_bias.row(r)));
  }
  return sum / static_cast<double>(batch.visible.rows());
}

Crbm exact_gradient(const Crbm& model, const CrbmBatch& batch) {
  const MatrixD states = all_states(model.hidden_bias.size());
  const MatrixD visible_bias = dynamic_visible_bias(model, batch.history);
  const MatrixD hidden_bias = dynamic_hidden_bias(model, batch.history);
  const MatrixD hidden = hidden_probability(model, batch.visible, hidden_bias);
  const Crbm data = statistics(model, batch, batch.visible, hidden);
  Crbm expected = model.with_parameters(Eigen::VectorXd::Zero(data.flattened().size()));
  for (Eigen::Index r = 0; r < batch.visible.rows(); ++r) {
    const Eigen::VectorXd logs =
        log_weights(model, states, visible_bias.row(r), hidden_bias.row(r));
    const Eigen::VectorXd probability = (logs.array() - log_sum_exp(logs)).exp();
    const MatrixD means =
        visible_mean(model, states, visible_bias.row(r).replicate(states.rows(), 1));
    const MatrixD weighted_means = probability.asDiagonal() * means;
    const RowVectorD v = weighted_means.colwise().sum();
    const RowVectorD h = probability.transpose() * states;
    expected.weights += weighted_means.transpose() * states;
    expected.visible_history +=
        batch.history.row(r).tail(model.visible_history.rows()).transpose() * v;
    expected.hidden_history +=
        batch.history.row(r).tail(model.hidden_history.rows()).transpose() * h;
    expected.visible_bias += v;
    expected.hidden_bias += h;
  }
  return model.with_parameters((data.flattened() - expected.flattened()) /
                               static_cast<double>(batch.visible.rows()));
}

}  // namespace mcdbn::reference
