#include "reference/update_error_bound.hpp"

#include <cmath>

namespace mcdbn::reference {
namespace {

/// l1 · sign(parameter), for parameters whose signs no error turns.
Bounded pull_of(const Bounded& parameter, const UpdateRule& rule) {
  return double{rule.l1} * Bounded::exact(parameter.value.cwiseSign());
}

}  // namespace

void bounded_momentum_update(Bounded& parameter, Bounded& velocity, const Bounded& uphill,
                             const UpdateRule& rule) {
  const Bounded gradient = rule.l1 > 0.0F ? uphill - pull_of(parameter, rule) : uphill;
  velocity = double{rule.momentum} * velocity +
             double{rule.rate} * (gradient - double{rule.weight_decay} * parameter);
  parameter = parameter + velocity;
}

void bounded_adam_update(Bounded& parameter, Bounded& mean, Bounded& square,
                         const Bounded& gradient, const UpdateRule& rule, int step) {
  const double beta1 = rule.momentum, beta2 = rule.beta2;
  mean = beta1 * mean + (1.0 - beta1) * gradient;
  square = beta2 * square + times((1.0 - beta2) * gradient, gradient);
  // Each correction is rounded to a float, then a division.
  const Bounded corrected_mean = divided(mean, 1.0 - std::pow(beta1, step));
  const Bounded corrected_square = divided(square, 1.0 - std::pow(beta2, step));
  const Bounded epsilon = Bounded::exact(
      MatrixD::Constant(square.value.rows(), square.value.cols(), double{rule.epsilon}));
  const Bounded direction = quotient(corrected_mean, square_root(corrected_square) + epsilon);
  const Bounded pull = double{rule.rate} * pull_of(parameter, rule);
  parameter = parameter - double{rule.rate} * (direction + double{rule.weight_decay} * parameter);
  if (rule.l1 > 0.0F) parameter = parameter - pull;
}

}  // namespace mcdbn::reference
