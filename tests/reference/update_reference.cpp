#include "reference/update_reference.hpp"

#include <cmath>

namespace mcdbn::reference {

void momentum_update(MatrixD& parameter, MatrixD& velocity, const MatrixD& gradient,
                     const UpdateRule& rule) {
  velocity = double{rule.momentum} * velocity +
             double{rule.rate} * (gradient - double{rule.weight_decay} * parameter -
                                  double{rule.l1} * parameter.cwiseSign());
  parameter += velocity;
}

void adam_update(MatrixD& parameter, MatrixD& mean, MatrixD& square, const MatrixD& gradient,
                 const UpdateRule& rule, int step) {
  const double beta1 = rule.momentum;
  const double beta2 = rule.beta2;
  mean = beta1 * mean + (1.0 - beta1) * gradient;
  square = beta2 * square + (1.0 - beta2) * gradient.cwiseAbs2();
  const MatrixD corrected_mean = mean / (1.0 - std::pow(beta1, step));
  const MatrixD corrected_square = square / (1.0 - std::pow(beta2, step));
  const MatrixD direction =
      corrected_mean.array() / (corrected_square.array().sqrt() + double{rule.epsilon});
  parameter -= double{rule.rate} * (direction + double{rule.weight_decay} * parameter +
                                    double{rule.l1} * parameter.cwiseSign());
}

}  // namespace mcdbn::reference
