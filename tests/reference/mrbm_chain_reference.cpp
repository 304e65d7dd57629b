#include "reference/mrbm_chain_reference.hpp"

#include <utility>

#include "reference/units_reference.hpp"

namespace mcdbn::reference {
namespace {

Bounded drawn(const Bounded& probability, const ClampedChain& chain, const PassDraws& draws,
              int pass) {
  const auto [temperature, relaxed] = std::pair(chain.temperature, chain.concrete);
  if (temperature == 0.0) return probability;
  const MatrixD uniform = draws(pass, probability.value.cols());
  const Bounded draw = relaxed ? concrete(probability, uniform) : bernoulli(probability, uniform);
  return !relaxed && temperature == 1.0 ? draw : tempered(probability, draw, temperature);
}

/// All 2^units states of that many binary units, one a row.
MatrixD all_states(Eigen::Index units) {
  return MatrixD::NullaryExpr(
      Eigen::Index{1} << units, units,
      [](Eigen::Index state, Eigen::Index unit) { return static_cast<double>(state >> unit & 1); });
}

/// Of each state, if its units are independent. @param on p(unit = 1) [rows x units]
/// @return [rows x states]
MatrixD state_probabilities(const MatrixD& on) {
  const MatrixD states = all_states(on.cols());
  MatrixD result = MatrixD::Ones(on.rows(), states.rows());
  for (Eigen::Index s = 0; s < states.rows(); ++s)
    for (Eigen::Index unit = 0; unit < on.cols(); ++unit)
      // on for a unit that is 1 in the state, else 1 − on
      result.col(s).array() *= (1.0 - states(s, unit) - on.col(unit).array()).abs();
  return result;
}

}  // namespace

Bounded bounded_clamped_chain(const Mrbm& model, int present, const MatrixD& values,
                              const ClampedChain& chain, const PassDraws& draws) {
  const int absent = 1 - present;
  const Bounded W = Bounded::exact(model.weights[absent]);
  const Bounded given = Bounded::exact(values), V = Bounded::exact(model.weights[present]);
  const Sum drive = Sum().add_product(given, V).add_row(Bounded::exact(model.hidden_bias));
  Bounded units, probability;
  for (int step = 0; step < chain.steps; ++step) {
    Sum input = drive;
    if (step > 0) input.add_product(units, W);
    if (step == 0 && chain.double_first_pass) input.add_product(given, V);
    const Bounded hidden = drawn(sigmoid(input.result()), chain, draws, 2 * step);
    probability = sigmoid(Sum()
                              .add_product(hidden, W.transposed())
                              .add_row(Bounded::exact(model.visible_bias[absent]))
                              .result());
    units = drawn(probability, chain, draws, 2 * step + 1);
  }
  return probability;
}

HiddenStates enumerate_hidden(const Mrbm& model, int present, const RowVectorD& values) {
  const int absent = 1 - present;
  const MatrixD& W = model.weights[absent];
  const MatrixD hidden = all_states(W.cols()), visible = all_states(W.rows());
  const RowVectorD drive = values * model.weights[present] + model.hidden_bias;
  const MatrixD absent_input = plus_row(hidden * W.transpose(), model.visible_bias[absent]);
  HiddenStates result;
  result.start = state_probabilities(sigmoid(MatrixD(drive)));
  result.absent = sigmoid(absent_input);
  result.transition = state_probabilities(result.absent) *
                      state_probabilities(sigmoid(plus_row(visible * W, drive)));
  // The absent units sum out of exp(−E): each leaves 1 + exp(what it takes).
  const Eigen::VectorXd unnormalized = (hidden * drive.transpose()).array().exp() *
                                       (1.0 + absent_input.array().exp()).rowwise().prod();
  result.stationary = unnormalized.transpose() / unnormalized.sum();
  return result;
}

}  // namespace mcdbn::reference
