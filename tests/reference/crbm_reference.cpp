#include "reference/crbm_reference.hpp"

#include <algorithm>

#include "reference/units_reference.hpp"
#include "reference/update_reference.hpp"

namespace mcdbn::reference {
namespace {

void update_row(RowVectorD& parameter, RowVectorD& velocity, const RowVectorD& gradient,
                const UpdateRule& rule) {
  MatrixD parameter_matrix = parameter;
  MatrixD velocity_matrix = velocity;
  momentum_update(parameter_matrix, velocity_matrix, gradient, rule);
  parameter = parameter_matrix;
  velocity = velocity_matrix;
}

}  // namespace

Eigen::VectorXd Crbm::flattened() const {
  Eigen::VectorXd flat(weights.size() + visible_history.size() + hidden_history.size() +
                       visible_bias.size() + hidden_bias.size());
  flat << weights.reshaped<Eigen::RowMajor>(), visible_history.reshaped<Eigen::RowMajor>(),
      hidden_history.reshaped<Eigen::RowMajor>(), visible_bias.transpose(), hidden_bias.transpose();
  return flat;
}

Crbm Crbm::with_parameters(const Eigen::VectorXd& flat) const {
  Crbm result = *this;
  Eigen::Index at = 0;
  const auto take = [&](auto& parameter) {
    std::copy_n(flat.data() + at, parameter.size(), parameter.data());
    at += parameter.size();
  };
  take(result.weights);
  take(result.visible_history);
  take(result.hidden_history);
  take(result.visible_bias);
  take(result.hidden_bias);
  return result;
}

MatrixD dynamic_visible_bias(const Crbm& model, const MatrixD& history) {
  return plus_row(history.rightCols(model.visible_history.rows()) * model.visible_history,
                  model.visible_bias);
}

MatrixD dynamic_hidden_bias(const Crbm& model, const MatrixD& history) {
  return plus_row(history.rightCols(model.hidden_history.rows()) * model.hidden_history,
                  model.hidden_bias);
}

MatrixD hidden_probability(const Crbm& model, const MatrixD& visible,
                           const MatrixD& dynamic_hidden_bias) {
  return sigmoid(MatrixD(dynamic_hidden_bias + visible * model.weights));
}

MatrixD visible_mean(const Crbm& model, const MatrixD& hidden,
                     const MatrixD& dynamic_visible_bias) {
  const MatrixD input = dynamic_visible_bias + hidden * model.weights.transpose();
  return model.visible_units == VisibleUnits::gaussian ? input : sigmoid(input);
}

Crbm statistics(const Crbm& model, const CrbmBatch& batch, const MatrixD& visible,
                const MatrixD& hidden) {
  Crbm sums = model;
  sums.weights = visible.transpose() * hidden;
  sums.visible_history =
      batch.history.rightCols(model.visible_history.rows()).transpose() * visible;
  sums.hidden_history = batch.history.rightCols(model.hidden_history.rows()).transpose() * hidden;
  sums.visible_bias = visible.colwise().sum();
  sums.hidden_bias = hidden.colwise().sum();
  return sums;
}

CdResult contrastive_divergence(const Crbm& model, const CrbmBatch& batch, int k,
                                const HiddenDraws& draws) {
  const MatrixD visible_bias = dynamic_visible_bias(model, batch.history);
  const MatrixD hidden_bias = dynamic_hidden_bias(model, batch.history);
  CdResult result;
  result.hidden = hidden_probability(model, batch.visible, hidden_bias);
  MatrixD probability = result.hidden;
  for (int step = 0; step < k; ++step) {
    const MatrixD uniform = draws(step);
    result.closest_draw = std::min(result.closest_draw, closest_draw(probability, uniform));
    const MatrixD hidden = bernoulli(probability, uniform);
    result.reconstruction = visible_mean(model, hidden, visible_bias);
    probability = hidden_probability(model, result.reconstruction, hidden_bias);
  }
  result.reconstruction_hidden = probability;

  const Crbm data = statistics(model, batch, batch.visible, result.hidden);
  const Crbm rec = statistics(model, batch, result.reconstruction, probability);
  result.gradient = model.with_parameters((data.flattened() - rec.flattened()) /
                                          static_cast<double>(batch.visible.rows()));
  return result;
}

void update(Crbm& model, Crbm& velocity, const Crbm& gradient, const UpdateRule& rule_W,
            const UpdateRule& rule_A, const UpdateRule& rule_B) {
  UpdateRule biases = rule_W;
  biases.weight_decay = biases.l1 = 0.0F;
  momentum_update(model.weights, velocity.weights, gradient.weights, rule_W);
  momentum_update(model.visible_history, velocity.visible_history, gradient.visible_history,
                  rule_A);
  momentum_update(model.hidden_history, velocity.hidden_history, gradient.hidden_history, rule_B);
  update_row(model.visible_bias, velocity.visible_bias, gradient.visible_bias, biases);
  update_row(model.hidden_bias, velocity.hidden_bias, gradient.hidden_bias, biases);
}

}  // namespace mcdbn::reference
