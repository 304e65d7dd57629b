#include "reference/mrbm_error_bound.hpp"

#include "reference/loss_error_bound.hpp"
#include "reference/update_error_bound.hpp"

namespace mcdbn::reference {
namespace {

/// One direction's share of the gradients.
struct Direction {
  Bounded by_hidden, by_values;  ///< of the absent modality's weights: the errors with the hidden
                                 ///< units, the values with the hidden units' errors
  Bounded present_weights;
  Bounded visible_bias;  ///< the absent modality's
  Bounded drive_error;   ///< at the input of the hidden units, Σ over the passes
  Bounded loss;
};

/// Back-propagated through every pass of eq 32 and 33.
Direction direction(const BoundedMrbm& model, std::size_t present,
                    const std::array<MatrixD, 2>& batch, int steps) {
  const std::size_t missing = 1 - present;
  const Bounded& W = model.weights[missing];
  const Bounded target = Bounded::exact(batch[missing]), values = Bounded::exact(batch[present]);
  // Stored, as it does not change; the absent modality's products go on from there.
  const Bounded drive =
      Sum().add_product(values, model.weights[present]).add_row(model.hidden_bias).result();
  std::vector<Bounded> hidden;
  std::vector<Bounded> visible{
      Bounded::exact(MatrixD::Zero(target.value.rows(), target.value.cols()))};
  for (int pass = 0; pass < steps; ++pass) {
    hidden.push_back(sigmoid(Sum().add(drive).add_product(visible.back(), W).result()));
    visible.push_back(sigmoid(Sum()
                                  .add_product(hidden.back(), W.transposed())
                                  .add_row(model.visible_bias[missing])
                                  .result()));
  }

  Sum by_hidden, by_values, visible_bias, drive_error;
  Bounded visible_error =
      divided(visible.back() - target, static_cast<double>(target.value.rows()));
  for (auto pass = static_cast<std::size_t>(steps); pass-- > 0;) {
    const Bounded hidden_error = times(product(visible_error, W), sigmoid_gradient(hidden[pass]));
    by_hidden.add_product(visible_error.transposed(), hidden[pass]);
    by_values.add_product(visible[pass].transposed(), hidden_error);
    visible_bias.add_column_sum(visible_error);
    drive_error.add(hidden_error);
    visible_error = times(product(hidden_error, W.transposed()), sigmoid_gradient(visible[pass]));
  }
  return {by_hidden.result(),
          by_values.result(),
          product(values.transposed(), drive_error.result()),
          visible_bias.result(),
          drive_error.result(),
          divided(cross_entropy(target, visible.back()), static_cast<double>(target.value.size()))};
}

}  // namespace

BoundedMrbm BoundedMrbm::exact(const Mrbm& model) {
  return {{Bounded::exact(model.weights[0]), Bounded::exact(model.weights[1])},
          {Bounded::exact(model.visible_bias[0]), Bounded::exact(model.visible_bias[1])},
          Bounded::exact(model.hidden_bias)};
}

BoundedMrbm BoundedMrbm::zeros_like(const BoundedMrbm& model) {
  const auto zeros = [](const Bounded& x) {
    return Bounded::exact(MatrixD::Zero(x.value.rows(), x.value.cols()));
  };
  return {{zeros(model.weights[0]), zeros(model.weights[1])},
          {zeros(model.visible_bias[0]), zeros(model.visible_bias[1])},
          zeros(model.hidden_bias)};
}

BoundedMultiPrediction bounded_multi_prediction(const BoundedMrbm& model,
                                                const std::array<MatrixD, 2>& batch, int steps) {
  // Direction m is the one in which modality m is absent.
  const std::array<Direction, 2> directions{direction(model, 1, batch, steps),
                                            direction(model, 0, batch, steps)};
  BoundedMultiPrediction result;
  for (std::size_t m = 0; m < 2; ++m) {
    result.gradient.weights[m] = Sum()
                                     .add(directions[m].by_hidden)
                                     .add(directions[m].by_values)
                                     .add(directions[1 - m].present_weights)
                                     .result();
    result.gradient.visible_bias[m] = directions[m].visible_bias;
    result.losses[m] = directions[m].loss;
  }
  result.gradient.hidden_bias = Sum()
                                    .add_column_sum(directions[0].drive_error)
                                    .add_column_sum(directions[1].drive_error)
                                    .result();
  return result;
}

void bounded_adam_update(BoundedMrbm& model, BoundedMrbm& mean, BoundedMrbm& square,
                         const BoundedMrbm& gradient, const UpdateRule& rule, int step) {
  UpdateRule biases = rule;
  biases.weight_decay = 0.0F;
  for (std::size_t m = 0; m < 2; ++m) {
    bounded_adam_update(model.weights[m], mean.weights[m], square.weights[m], gradient.weights[m],
                        rule, step);
    bounded_adam_update(model.visible_bias[m], mean.visible_bias[m], square.visible_bias[m],
                        gradient.visible_bias[m], biases, step);
  }
  bounded_adam_update(model.hidden_bias, mean.hidden_bias, square.hidden_bias, gradient.hidden_bias,
                      biases, step);
}

}  // namespace mcdbn::reference
