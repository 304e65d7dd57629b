#include "reference/crbm_error_bound.hpp"

namespace mcdbn::reference {
namespace {

Bounded stacked(const Bounded& top, const Bounded& bottom) {
  Bounded result{MatrixD(top.value.rows() + bottom.value.rows(), top.value.cols()),
                 MatrixD(top.value.rows() + bottom.value.rows(), top.value.cols())};
  result.value << top.value, bottom.value;
  result.bound << top.bound, bottom.bound;
  return result;
}

/// One parameter and its velocity after the update of `gradient`.
void update_one(const MatrixD& parameter, const Bounded& gradient, const UpdateRule& rule,
                Bounded& updated, Bounded& velocity) {
  const Bounded exact = Bounded::exact(parameter);
  velocity = double{rule.rate} * (gradient - double{rule.weight_decay} * exact);
  updated = exact + velocity;
}

}  // namespace

BoundedCdStep bounded_cd_step(const Crbm& model, const CrbmBatch& batch, int k,
                              const HiddenDraws& draws, const UpdateRule& rule_W,
                              const UpdateRule& rule_A, const UpdateRule& rule_B) {
  const Bounded W = Bounded::exact(model.weights);
  const Bounded history = Bounded::exact(batch.history);
  const Bounded data = Bounded::exact(batch.visible);
  const Bounded visible_bias = plus_row(product(history, Bounded::exact(model.visible_history)),
                                        Bounded::exact(model.visible_bias));
  const Bounded hidden_bias = plus_row(product(history, Bounded::exact(model.hidden_history)),
                                       Bounded::exact(model.hidden_bias));
  const auto hidden_of = [&](const Bounded& visible) {
    return sigmoid(hidden_bias + product(visible, W));
  };

  BoundedCdStep step;
  const Bounded hidden_data = hidden_of(data);
  Bounded hidden = hidden_data, visible = data;
  for (int gibbs_step = 0; gibbs_step < k; ++gibbs_step) {
    const Bounded sample = bernoulli(hidden, draws(gibbs_step));
    step.uncertain_draws += sample.bound.mean() / k;
    visible = visible_bias + product(sample, W.transposed());
    if (model.visible_units == VisibleUnits::binary) visible = sigmoid(visible);
    hidden = hidden_of(visible);
  }

  const double mean = 1.0 / static_cast<double>(batch.visible.rows());
  const Bounded visible_change = mean * (data - visible);
  const Bounded hidden_change = mean * (hidden_data - hidden);
  // Data and reconstruction in one sum, whichever way the device splits it.
  const Bounded statistics_W =
      product(stacked(data, -1.0 * visible).transposed(), stacked(hidden_data, hidden));
  UpdateRule biases = rule_W;
  biases.weight_decay = 0.0F;
  BoundedCrbm &p = step.parameters, &v = step.velocities;
  update_one(model.weights, mean * statistics_W, rule_W, p.W, v.W);
  update_one(model.visible_history, product(history.transposed(), visible_change), rule_A, p.A,
             v.A);
  update_one(model.hidden_history, product(history.transposed(), hidden_change), rule_B, p.B, v.B);
  update_one(model.visible_bias, column_sum(visible_change), biases, p.a, v.a);
  update_one(model.hidden_bias, column_sum(hidden_change), biases, p.b, v.b);
  return step;
}

}  // namespace mcdbn::reference
