#include "reference/product_reference.hpp"

#include "reference/error_bounds.hpp"
#include "reference/units_reference.hpp"

namespace mcdbn::reference {
namespace {

/// mean + temperature·(drawn − mean) where `drawn` itself is off by at most drawn.bound.
Bounded tempered(const MatrixD& mean, const Bounded& drawn, double temperature) {
  Bounded result;
  const MatrixD difference = drawn.value - mean;
  result.value = mean + temperature * difference;
  // Three roundings: the difference, its product with the temperature, the sum.
  result.bound = std::abs(temperature) * drawn.bound * (1.0 + gamma_n(3)) +
                 gamma_n(3) * (mean.cwiseAbs() + std::abs(temperature) * difference.cwiseAbs());
  return result;
}

}  // namespace

Bounded product(const MatrixD& a, const MatrixD& b, double alpha, double beta, const MatrixD& c) {
  Bounded result{alpha * a * b, std::abs(alpha) * a.cwiseAbs() * b.cwiseAbs()};
  if (beta != 0.0) {
    result.value += beta * c;
    result.bound += std::abs(beta) * c.cwiseAbs();
  }
  result.bound *= gamma_n(static_cast<double>(a.cols()) + 2.0);
  return result;
}

Bounded plus_bias(const Bounded& x, const MatrixD& bias) {
  const MatrixD full = bias.rows() == x.value.rows() ? bias : bias.replicate(x.value.rows(), 1);
  Bounded result;
  result.value = x.value + full;
  result.bound = (1.0 + kRoundoff) * x.bound + kRoundoff * result.value.cwiseAbs();
  return result;
}

Bounded sigmoid_gradient(const Bounded& x, const MatrixD& y) {
  const MatrixD slope = y.array() * (1.0 - y.array());
  Bounded result;
  result.value = x.value.cwiseProduct(slope);
  result.bound = (1.0 + gamma_n(3)) * x.bound.cwiseProduct(slope.cwiseAbs()) +
                 gamma_n(3) * result.value.cwiseAbs() +
                 MatrixD::Constant(y.rows(), y.cols(), kSmallestNormal);
  return result;
}

Bounded relu(const Bounded& x) {
  return {x.value.cwiseMax(0.0), x.bound};
}

Bounded relu_gradient(const Bounded& x, const MatrixD& y) {
  const MatrixD open = (y.array() > 0.0).cast<double>();
  return {x.value.cwiseProduct(open), x.bound.cwiseProduct(open)};
}

Bounded centered_sigmoid(const Bounded& x) {
  const Bounded probability = sigmoid(x);
  const MatrixD value = (probability.value.array() - 0.5).matrix();
  return {value, probability.bound + kRoundoff * value.cwiseAbs()};
}

Bounded centered_sigmoid_gradient(const Bounded& x, const MatrixD& y, double kept_share) {
  const MatrixD units = kept_share * y;
  const MatrixD open = kept_share < 1.0 ? MatrixD((y.array() != 0.0).cast<double>())
                                        : MatrixD::Ones(y.rows(), y.cols());
  const MatrixD slope = ((0.25 - units.array().square()) / kept_share * open.array()).matrix();
  // Two products and a difference on the way to the slope, whose terms may cancel; the division;
  // and the product with the error.
  const MatrixD slope_bound =
      (gamma_n(3 + kDivisionError) * (0.25 + units.array().square()) / kept_share * open.array())
          .matrix();
  const MatrixD value = x.value.cwiseProduct(slope);
  return {value, x.bound.cwiseProduct(slope.cwiseAbs() + slope_bound) +
                     x.value.cwiseAbs().cwiseProduct(slope_bound) + kRoundoff * value.cwiseAbs()};
}

Bounded gaussian_sample(const MatrixD& mean, const MatrixD& normal, double temperature) {
  Bounded drawn;
  drawn.value = mean + normal;
  drawn.bound = gamma_n(kLogError / 2 + kSqrtError + kCospiError + 1) * normal.cwiseAbs() +
                kRoundoff * drawn.value.cwiseAbs();
  return tempered(mean, drawn, temperature);
}

Bounded bernoulli_sample(const MatrixD& probability, const MatrixD& bits, double temperature) {
  return tempered(probability, {bits, MatrixD::Zero(bits.rows(), bits.cols())}, temperature);
}

}  // namespace mcdbn::reference
