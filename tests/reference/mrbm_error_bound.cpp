#include "reference/mrbm_error_bound.hpp"

#include "reference/loss_error_bound.hpp"
#include "reference/update_error_bound.hpp"

namespace mcdbn::reference {
namespace {

/// One direction's share of the gradients.
struct Direction {
  Bounded by_hidden, by_values;  ///< of the absent modality's weights: the errors with the hidden
                                 ///< units, the values with the hidden units' errors
  Bounded visible_bias;          ///< the absent modality's
  Bounded present_input_error;   ///< at the input of the hidden units, Σ over the passes
  Bounded loss;
};

bool is_gaussian(const BoundedMrbm& model, std::size_t m) {
  return m < model.gaussian.size() && model.gaussian[m];
}

/// What the present modalities give the hidden units. Stored, as it does not change; the absent
/// modality's products go on from there.
Bounded present_input_of(const BoundedMrbm& model, std::size_t missing,
                         const std::vector<MatrixD>& batch) {
  Sum present_input;
  for (std::size_t m = 0; m < batch.size(); ++m)
    if (m != missing) present_input.add_product(Bounded::exact(batch[m]), model.weights[m]);
  return present_input.add_row(model.hidden_bias).result();
}

Bounded half_squares(const Bounded& target, const Bounded& prediction) {
  const Bounded error = target - prediction;
  Bounded squares = times(error, error);
  squares.value *= 0.5;
  squares.bound *= 0.5;
  return Sum().add_column_sum(Sum().add_column_sum(squares).result().transposed()).result();
}

/// Back-propagated through every pass of eq 32 and 33.
Direction direction(const BoundedMrbm& model, std::size_t missing,
                    const std::vector<MatrixD>& batch, int steps) {
  const bool gaussian = is_gaussian(model, missing);
  const Bounded& W = model.weights[missing];
  const Bounded target = Bounded::exact(batch[missing]);
  const Bounded present_input = present_input_of(model, missing, batch);
  std::vector<Bounded> hidden;
  std::vector<Bounded> visible{
      Bounded::exact(MatrixD::Zero(target.value.rows(), target.value.cols()))};
  for (int pass = 0; pass < steps; ++pass) {
    hidden.push_back(sigmoid(Sum().add(present_input).add_product(visible.back(), W).result()));
    const Bounded input = Sum()
                              .add_product(hidden.back(), W.transposed())
                              .add_row(model.visible_bias[missing])
                              .result();
    visible.push_back(gaussian ? input : sigmoid(input));
  }

  Sum by_hidden, by_values, visible_bias, present_input_error;
  Bounded visible_error =
      divided(visible.back() - target, static_cast<double>(target.value.rows()));
  for (auto pass = static_cast<std::size_t>(steps); pass-- > 0;) {
    const Bounded hidden_error = times(product(visible_error, W), sigmoid_gradient(hidden[pass]));
    by_hidden.add_product(visible_error.transposed(), hidden[pass]);
    by_values.add_product(visible[pass].transposed(), hidden_error);
    visible_bias.add_column_sum(visible_error);
    present_input_error.add(hidden_error);
    visible_error = product(hidden_error, W.transposed());
    if (!gaussian) visible_error = times(visible_error, sigmoid_gradient(visible[pass]));
  }
  const Bounded loss =
      gaussian ? half_squares(target, visible.back()) : cross_entropy(target, visible.back());
  return {by_hidden.result(), by_values.result(), visible_bias.result(),
          present_input_error.result(), divided(loss, static_cast<double>(target.value.size()))};
}

}  // namespace

BoundedMrbm BoundedMrbm::exact(const Mrbm& model) {
  BoundedMrbm result{{}, {}, Bounded::exact(model.hidden_bias), model.gaussian};
  for (const MatrixD& weights : model.weights) result.weights.push_back(Bounded::exact(weights));
  for (const RowVectorD& bias : model.visible_bias)
    result.visible_bias.push_back(Bounded::exact(bias));
  return result;
}

BoundedMrbm BoundedMrbm::zeros_like(const BoundedMrbm& model) {
  BoundedMrbm result = model;
  const auto clear = [](Bounded& x) {
    x = Bounded::exact(MatrixD::Zero(x.value.rows(), x.value.cols()));
  };
  for (Bounded& weights : result.weights) clear(weights);
  for (Bounded& bias : result.visible_bias) clear(bias);
  clear(result.hidden_bias);
  return result;
}

BoundedMultiPrediction bounded_multi_prediction(const BoundedMrbm& model,
                                                const std::vector<MatrixD>& batch, int steps) {
  // Direction m is the one in which modality m is absent.
  std::vector<Direction> directions;
  Sum hidden_bias;
  BoundedMultiPrediction result;
  for (std::size_t m = 0; m < batch.size(); ++m) {
    directions.push_back(direction(model, m, batch, steps));
    hidden_bias.add_column_sum(directions[m].present_input_error);
    result.gradient.visible_bias.push_back(directions[m].visible_bias);
    result.losses.push_back(directions[m].loss);
  }
  for (std::size_t m = 0; m < batch.size(); ++m) {
    Sum weights;
    weights.add(directions[m].by_hidden).add(directions[m].by_values);
    for (std::size_t other = 0; other < batch.size(); ++other)
      if (other != m)
        weights.add(
            product(Bounded::exact(batch[m]).transposed(), directions[other].present_input_error));
    result.gradient.weights.push_back(weights.result());
  }
  result.gradient.hidden_bias = hidden_bias.result();
  result.gradient.gaussian = model.gaussian;
  return result;
}

void bounded_momentum_update(BoundedMrbm& model, BoundedMrbm& velocity, const BoundedMrbm& gradient,
                             const UpdateRule& rule) {
  for (std::size_t m = 0; m < model.weights.size(); ++m) {
    bounded_momentum_update(model.weights[m], velocity.weights[m], -gradient.weights[m], rule);
    bounded_momentum_update(model.visible_bias[m], velocity.visible_bias[m],
                            -gradient.visible_bias[m], rule.without_decay());
  }
  bounded_momentum_update(model.hidden_bias, velocity.hidden_bias, -gradient.hidden_bias,
                          rule.without_decay());
}

void bounded_adam_update(BoundedMrbm& model, BoundedMrbm& mean, BoundedMrbm& square,
                         const BoundedMrbm& gradient, const UpdateRule& rule, int step) {
  UpdateRule biases = rule;
  biases.weight_decay = 0.0F;
  for (std::size_t m = 0; m < model.weights.size(); ++m) {
    bounded_adam_update(model.weights[m], mean.weights[m], square.weights[m], gradient.weights[m],
                        rule, step);
    bounded_adam_update(model.visible_bias[m], mean.visible_bias[m], square.visible_bias[m],
                        gradient.visible_bias[m], biases, step);
  }
  bounded_adam_update(model.hidden_bias, mean.hidden_bias, square.hidden_bias, gradient.hidden_bias,
                      biases, step);
}

}  // namespace mcdbn::reference
