#pragma once

#include <cmath>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn::test {

/// A matrix of parameters with Adam's moments, in double.
struct AdamReference {
  MatrixD value, mean, square;
  explicit AdamReference(const MatrixD& start)
      : value(start),
        mean(MatrixD::Zero(start.rows(), start.cols())),
        square(MatrixD::Zero(start.rows(), start.cols())) {}

  /// Kingma and Ba (2015), weight decay decoupled.
  void update(const MatrixD& gradient, double rate, double decay, int step) {
    const double beta1 = 0.9, beta2 = 0.999;
    mean = beta1 * mean + (1 - beta1) * gradient;
    square = (beta2 * square.array() + (1 - beta2) * gradient.array().square()).matrix();
    const MatrixD direction = ((mean.array() / (1 - std::pow(beta1, step))) /
                               ((square.array() / (1 - std::pow(beta2, step))).sqrt() + 1e-8))
                                  .matrix();
    value -= rate * (direction + decay * value);
  }
};

}  // namespace mcdbn::test
