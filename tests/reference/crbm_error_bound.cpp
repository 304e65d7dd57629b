#include "reference/crbm_error_bound.hpp"

#include "reference/loss_error_bound.hpp"
#include "reference/update_error_bound.hpp"

namespace mcdbn::reference {

BoundedCrbm BoundedCrbm::exact(const Crbm& model) {
  return {model.visible_units,
          Bounded::exact(model.weights),
          Bounded::exact(model.visible_history),
          Bounded::exact(model.hidden_history),
          Bounded::exact(model.visible_bias),
          Bounded::exact(model.hidden_bias)};
}

BoundedCrbm BoundedCrbm::zeros_like(const Crbm& model) {
  return exact(model.with_parameters(Eigen::VectorXd::Zero(model.flattened().size())));
}

BoundedCdStep bounded_cd_step(const BoundedCrbm& model, const BoundedCrbm& velocities,
                              const CrbmBatch& batch, int k, const HiddenDraws& draws,
                              const UpdateRule& rule_W, const UpdateRule& rule_A,
                              const UpdateRule& rule_B) {
  const Bounded data = Bounded::exact(batch.visible);
  const Bounded seen_by_A = Bounded::exact(batch.history.rightCols(model.A.value.rows())),
                seen_by_B = Bounded::exact(batch.history.rightCols(model.B.value.rows()));
  // The device stores the dynamic biases (eq 16, 17); the other layer's products go on from there.
  const Bounded visible_bias = Sum().add_product(seen_by_A, model.A).add_row(model.a).result();
  const Bounded hidden_bias = Sum().add_product(seen_by_B, model.B).add_row(model.b).result();
  const auto hidden_of = [&](const Bounded& visible) {
    return sigmoid(Sum().add(hidden_bias).add_product(visible, model.W).result());
  };

  BoundedCdStep step{model, velocities, {}, 0};
  const Bounded hidden_data = hidden_of(data);
  Bounded hidden = hidden_data, visible = data;
  for (int gibbs_step = 0; gibbs_step < k; ++gibbs_step) {
    const Bounded sample = bernoulli(hidden, draws(gibbs_step));
    step.uncertain_draws += sample.bound.mean() / k;
    visible = Sum().add(visible_bias).add_product(sample, model.W.transposed()).result();
    if (model.visible_units == VisibleUnits::binary) visible = sigmoid(visible);
    hidden = hidden_of(visible);
  }
  step.loss = divided(squared_error(data, visible), static_cast<double>(data.value.size()));

  // Data and reconstruction in one sum, whichever way the device splits it, and the mean taken of
  // the sum or of every term.
  const auto cases = static_cast<double>(data.value.rows());
  const Bounded visible_change = data - visible, hidden_change = hidden_data - hidden;
  const Bounded gradient_W = Sum()
                                 .add_product(data.transposed(), hidden_data)
                                 .add_product(-visible.transposed(), hidden)
                                 .divide(cases)
                                 .result();
  const auto learnt_from = [&](const Bounded& history, const Bounded& change) {
    return Sum().add_product(history.transposed(), change).divide(cases).result();
  };
  const auto mean_of = [&](const Bounded& change) {
    return Sum().add_column_sum(change).divide(cases).result();
  };
  UpdateRule biases = rule_W;
  biases.weight_decay = 0.0F;
  BoundedCrbm &p = step.parameters, &v = step.velocities;
  bounded_momentum_update(p.W, v.W, gradient_W, rule_W);
  bounded_momentum_update(p.A, v.A, learnt_from(seen_by_A, visible_change), rule_A);
  bounded_momentum_update(p.B, v.B, learnt_from(seen_by_B, hidden_change), rule_B);
  bounded_momentum_update(p.a, v.a, mean_of(visible_change), biases);
  bounded_momentum_update(p.b, v.b, mean_of(hidden_change), biases);
  return step;
}

}  // namespace mcdbn::reference
