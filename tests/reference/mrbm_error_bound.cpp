#include "reference/mrbm_error_bound.hpp"

namespace mcdbn::reference {
namespace {

/// One direction's gradient, back-propagated through every pass of eq 32 and 33.
BoundedMrbm direction(const Mrbm& model, int present, const std::array<MatrixD, 2>& batch,
                      int steps) {
  const int missing = 1 - present;
  const Bounded W = Bounded::exact(model.weights[missing]);
  const Bounded target = Bounded::exact(batch[missing]), values = Bounded::exact(batch[present]);
  const Bounded drive = plus_row(product(values, Bounded::exact(model.weights[present])),
                                 Bounded::exact(model.hidden_bias));
  std::vector<Bounded> hidden;
  std::vector<Bounded> visible{
      Bounded::exact(MatrixD::Zero(target.value.rows(), target.value.cols()))};
  for (int pass = 0; pass < steps; ++pass) {
    hidden.push_back(sigmoid(drive + product(visible.back(), W)));
    visible.push_back(sigmoid(plus_row(product(hidden.back(), W.transposed()),
                                       Bounded::exact(model.visible_bias[missing]))));
  }

  const auto zeros = [](const MatrixD& like) {
    return Bounded::exact(MatrixD::Zero(like.rows(), like.cols()));
  };
  BoundedMrbm gradient;
  gradient.weights[missing] = zeros(model.weights[missing]);
  gradient.visible_bias[missing] = zeros(model.visible_bias[missing]);
  Bounded drive_error = zeros(drive.value);
  Bounded visible_error =
      (1.0 / static_cast<double>(target.value.rows())) * (visible.back() - target);
  for (int pass = steps - 1; pass >= 0; --pass) {
    const Bounded hidden_error =
        times(product(visible_error, W), sigmoid_gradient(hidden[static_cast<std::size_t>(pass)]));
    gradient.weights[missing] =
        gradient.weights[missing] +
        product(visible_error.transposed(), hidden[static_cast<std::size_t>(pass)]) +
        product(visible[static_cast<std::size_t>(pass)].transposed(), hidden_error);
    gradient.visible_bias[missing] = gradient.visible_bias[missing] + column_sum(visible_error);
    drive_error = drive_error + hidden_error;
    visible_error = times(product(hidden_error, W.transposed()),
                          sigmoid_gradient(visible[static_cast<std::size_t>(pass)]));
  }
  gradient.weights[present] = product(values.transposed(), drive_error);
  gradient.visible_bias[present] = zeros(model.visible_bias[present]);
  gradient.hidden_bias = column_sum(drive_error);
  return gradient;
}

}  // namespace

BoundedMrbm bounded_multi_prediction(const Mrbm& model, const std::array<MatrixD, 2>& batch,
                                     int steps) {
  BoundedMrbm sum = direction(model, 0, batch, steps);
  const BoundedMrbm back = direction(model, 1, batch, steps);
  for (std::size_t m = 0; m < 2; ++m) {
    sum.weights[m] = sum.weights[m] + back.weights[m];
    sum.visible_bias[m] = sum.visible_bias[m] + back.visible_bias[m];
  }
  sum.hidden_bias = sum.hidden_bias + back.hidden_bias;
  return sum;
}

}  // namespace mcdbn::reference
