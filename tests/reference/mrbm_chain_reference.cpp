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

Bounded drawn_normal(const Bounded& mean, const ClampedChain& chain, const PassDraws& draws,
                     int pass) {
  if (chain.temperature == 0.0) return mean;
  return tempered(mean, gaussian(mean, draws(pass, mean.value.cols())), chain.temperature);
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

std::vector<Bounded> bounded_chain(const Mrbm& model, const std::vector<bool>& present,
                                   const std::vector<MatrixD>& values, const ClampedChain& chain,
                                   const PassDraws& uniform, const PassDraws& normal) {
  const std::size_t modalities = present.size();
  Sum present_input;  // where nothing is present, b alone
  for (std::size_t m = 0; m < modalities; ++m)
    present_input.add_product(Bounded::exact(present[m] ? values[m] : MatrixD(0.0 * values[m])),
                              Bounded::exact(model.weights[m]));
  present_input.add_row(Bounded::exact(model.hidden_bias));
  std::vector<Bounded> units(modalities), means(modalities);
  int pass = 0;
  for (int step = 0; step < chain.steps; ++step) {
    Sum input = present_input;
    for (std::size_t m = 0; m < modalities; ++m)
      if (!present[m] && step > 0) input.add_product(units[m], Bounded::exact(model.weights[m]));
    const Bounded hidden = drawn(sigmoid(input.result()), chain, uniform, pass++);
    for (std::size_t m = 0; m < modalities; ++m) {
      if (present[m]) continue;
      means[m] = Sum()
                     .add_product(hidden, Bounded::exact(model.weights[m]).transposed())
                     .add_row(Bounded::exact(model.visible_bias[m]))
                     .result();
      if (!model.is_gaussian(m)) means[m] = sigmoid(means[m]);
      units[m] = model.is_gaussian(m) ? drawn_normal(means[m], chain, normal, pass)
                                      : drawn(means[m], chain, uniform, pass);
      ++pass;
    }
  }
  return means;
}

Bounded bounded_clamped_chain(const Mrbm& model, int present, const MatrixD& values,
                              const ClampedChain& chain, const PassDraws& draws) {
  std::vector<MatrixD> both(2, values);
  both[static_cast<std::size_t>(1 - present)] =
      MatrixD::Zero(values.rows(), model.weights[static_cast<std::size_t>(1 - present)].rows());
  return bounded_chain(model, {present == 0, present == 1}, both, chain, draws,
                       {})[static_cast<std::size_t>(1 - present)];
}

HiddenStates enumerate_hidden(const Mrbm& model, int present, const RowVectorD& values) {
  const int absent = 1 - present;
  const MatrixD& W = model.weights[absent];
  const MatrixD hidden = all_states(W.cols()), visible = all_states(W.rows());
  const RowVectorD present_input = values * model.weights[present] + model.hidden_bias;
  const MatrixD absent_input = plus_row(hidden * W.transpose(), model.visible_bias[absent]);
  HiddenStates result;
  result.start = state_probabilities(sigmoid(MatrixD(present_input)));
  result.absent = sigmoid(absent_input);
  result.transition = state_probabilities(result.absent) *
                      state_probabilities(sigmoid(plus_row(visible * W, present_input)));
  // The absent units sum out of exp(−E): each leaves 1 + exp(what it takes).
  const Eigen::VectorXd unnormalized = (hidden * present_input.transpose()).array().exp() *
                                       (1.0 + absent_input.array().exp()).rowwise().prod();
  result.stationary = unnormalized.transpose() / unnormalized.sum();
  return result;
}

}  // namespace mcdbn::reference
