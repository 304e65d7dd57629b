#include "reference/cd_options_reference.hpp"

#include <algorithm>

#include "reference/units_reference.hpp"
#include "reference/update_reference.hpp"

namespace mcdbn::reference {
namespace {

constexpr double kActivityKept = 0.9F, kFastKept = 19.0F / 20.0F;

Crbm zeros_like(const Crbm& model) {
  return model.with_parameters(Eigen::VectorXd::Zero(model.flattened().size()));
}

}  // namespace

CdTraining::CdTraining(const Crbm& start)
    : model(start),
      deviation(RowVectorD::Ones(start.visible_bias.size())),
      fast(zeros_like(start)),
      gradient(zeros_like(start)),
      velocity_(zeros_like(start)),
      square_(zeros_like(start)) {}

void CdTraining::step(const CrbmBatch& given, const CdOptions& options, const ChainDraws& draws) {
  ++steps_;
  CrbmBatch batch = given;
  batch.visible.array().rowwise() /= deviation.array();
  const auto cases = static_cast<double>(batch.visible.rows());
  const auto drawn = [&](const MatrixD& probability, int gibbs_step) {
    const MatrixD uniform = draws.hidden(gibbs_step);
    closest_draw = std::min(closest_draw, reference::closest_draw(probability, uniform));
    return bernoulli(probability, uniform);
  };
  MatrixD hidden_data =
      hidden_probability(model, batch.visible, dynamic_hidden_bias(model, batch.history));

  // The chain's machine: the parameters and their fast parts, which are zero unless there is a
  // rate.
  const Crbm moved = model.with_parameters(model.flattened() + fast.flattened());
  const MatrixD visible_bias = dynamic_visible_bias(moved, batch.history);
  const MatrixD hidden_bias = dynamic_hidden_bias(moved, batch.history);
  const bool goes_on = options.persistent && particles.size() > 0;
  MatrixD hidden = goes_on ? particles : drawn(hidden_data, 0), visible, probability;
  for (int k = 1; k <= options.gibbs_steps; ++k) {
    visible = visible_mean(moved, hidden, visible_bias);
    if (options.sample_visible && model.visible_units == VisibleUnits::gaussian) {
      visible += draws.visible(k);
    } else if (options.sample_visible) {
      closest_draw = std::min(closest_draw, reference::closest_draw(visible, draws.visible(k)));
      visible = bernoulli(visible, draws.visible(k));
    }
    if (batch.seen.size() > 0) visible.array() *= batch.seen.array();
    probability = hidden_probability(moved, visible, hidden_bias);
    if (k < options.gibbs_steps || options.persistent) hidden = drawn(probability, k);
  }
  particles = hidden;
  MatrixD error = batch.visible - visible;
  error.array().rowwise() *= deviation.array();
  loss = error.squaredNorm() / static_cast<double>(batch.visible.size());

  if (options.deviation_rate > 0) {
    const MatrixD reconstruction =
        visible_mean(model, hidden_data, model.visible_bias.replicate(batch.visible.rows(), 1));
    const RowVectorD derivative =
        batch.visible.cwiseProduct(batch.visible - reconstruction).colwise().mean().array() - 1.0;
    deviation.array() *= (options.deviation_rate * derivative.array()).exp();
  }
  if (options.sparsity_strength > 0) {
    const RowVectorD now = hidden_data.colwise().mean();
    activity_ = activity_.size() == 0
                    ? now
                    : RowVectorD(kActivityKept * activity_ + (1.0 - kActivityKept) * now);
    const RowVectorD pull =
        options.sparsity_strength * (activity_.array() - options.sparsity_target);
    hidden_data.rowwise() -= pull;
  }
  const Crbm data = statistics(model, batch, batch.visible, hidden_data);
  const Crbm end = statistics(model, batch, visible, probability);
  gradient = model.with_parameters((data.flattened() - end.flattened()) / cases);
  update(options);
}

void CdTraining::update(const CdOptions& options) {
  UpdateRule biases = options.W;
  biases.weight_decay = biases.l1 = 0.0F;
  const auto move = [&](auto& parameter, auto& velocity, auto& square, const auto& uphill,
                        const UpdateRule& rule) {
    MatrixD value = parameter, first = velocity, second = square;
    if (options.adam)
      adam_update(value, first, second, -uphill, rule, steps_);
    else
      momentum_update(value, first, uphill, rule);
    parameter = value;
    velocity = first;
    square = second;
  };
  Crbm &v = velocity_, &s = square_;
  move(model.weights, v.weights, s.weights, gradient.weights, options.W);
  move(model.visible_history, v.visible_history, s.visible_history, gradient.visible_history,
       options.A);
  move(model.hidden_history, v.hidden_history, s.hidden_history, gradient.hidden_history,
       options.B);
  move(model.visible_bias, v.visible_bias, s.visible_bias, gradient.visible_bias, biases);
  move(model.hidden_bias, v.hidden_bias, s.hidden_bias, gradient.hidden_bias, biases);
  fast.weights = kFastKept * fast.weights + options.fast_rate * gradient.weights;
  fast.visible_bias = kFastKept * fast.visible_bias + options.fast_rate * gradient.visible_bias;
  fast.hidden_bias = kFastKept * fast.hidden_bias + options.fast_rate * gradient.hidden_bias;
}

}  // namespace mcdbn::reference
