#include "reference/running_error.hpp"

#include "reference/error_bounds.hpp"
#include "reference/units_reference.hpp"

namespace mcdbn::reference {
namespace {

MatrixD constant_like(const MatrixD& x, double value) {
  return MatrixD::Constant(x.rows(), x.cols(), value);
}

/// The bound of an inexact operand's operation plus the rounding of its own result.
Bounded rounded(const MatrixD& value, const MatrixD& error, double operations = 1.0) {
  const MatrixD largest = value.cwiseAbs() + error;
  return {value, error + gamma_n(operations) * largest + constant_like(value, kSmallestNormal)};
}

/// Of a product with `factor`: its own, and that of the factor where it is no float.
double roundings_of(double factor) {
  return static_cast<double>(static_cast<float>(factor)) == factor ? 1.0 : 2.0;
}

/// A division, or the product with a reciprocal that was rounded itself.
constexpr double kDividedError = kDivisionError + 1.0;

/// How far the product of numbers within their bounds may lie from that of the values.
template <typename Times>
MatrixD inherited_error(const Bounded& x, const Bounded& y, Times&& times) {
  return times(x.value.cwiseAbs() + x.bound, y.bound) + times(x.bound, y.value.cwiseAbs());
}

}  // namespace

Bounded Bounded::exact(const MatrixD& value) {
  return {value, MatrixD::Zero(value.rows(), value.cols())};
}

Bounded exact(const MatrixF& values) {
  return Bounded::exact(values.cast<double>());
}

Sum& Sum::add_terms(const MatrixD& value, const MatrixD& inherited, const MatrixD& size,
                    double count) {
  if (roundings_ == 0) {
    value_ = value;
    inherited_ = inherited;
    size_ = size;
  } else {
    value_ += value;
    inherited_ += inherited;
    size_ += size;
  }
  roundings_ += count;
  return *this;
}

Sum& Sum::add(const Bounded& term) {
  return add_terms(term.value, term.bound, term.value.cwiseAbs() + term.bound, 1.0);
}

Sum& Sum::add_row(const Bounded& row) {
  return add({row.value.replicate(value_.rows(), 1), row.bound.replicate(value_.rows(), 1)});
}

Sum& Sum::add_product(const Bounded& x, const Bounded& y) {
  const auto times = [](const MatrixD& a, const MatrixD& b) { return MatrixD(a * b); };
  return add_terms(x.value * y.value, inherited_error(x, y, times),
                   (x.value.cwiseAbs() + x.bound) * (y.value.cwiseAbs() + y.bound),
                   static_cast<double>(x.value.cols()));
}

Sum& Sum::add_column_sum(const Bounded& x) {
  return add_product(Bounded::exact(MatrixD::Ones(1, x.value.rows())), x);
}

Sum& Sum::scale(double factor) {
  value_ *= factor;
  inherited_ *= std::abs(factor);
  size_ *= std::abs(factor);
  roundings_ += roundings_of(factor);
  return *this;
}

Sum& Sum::divide(double count) {
  value_ /= count;
  inherited_ /= count;
  size_ /= count;
  roundings_ += kDividedError;
  return *this;
}

Bounded Sum::result() const {
  return {value_, inherited_ + gamma_n(roundings_) * size_ +
                      constant_like(value_, roundings_ * kSmallestNormal)};
}

Bounded operator-(const Bounded& x) {
  return {-x.value, x.bound};
}

Bounded operator+(const Bounded& x, const Bounded& y) {
  return rounded(x.value + y.value, x.bound + y.bound);
}

Bounded operator-(const Bounded& x, const Bounded& y) {
  return x + -y;
}

Bounded operator*(double factor, const Bounded& x) {
  return rounded(factor * x.value, std::abs(factor) * x.bound, roundings_of(factor));
}

Bounded divided(const Bounded& x, double count) {
  return rounded(x.value / count, x.bound / count, kDividedError);
}

Bounded product(const Bounded& x, const Bounded& y) {
  return Sum().add_product(x, y).result();
}

Bounded times(const Bounded& x, const Bounded& y) {
  const auto entry_by_entry = [](const MatrixD& a, const MatrixD& b) {
    return MatrixD(a.cwiseProduct(b));
  };
  return rounded(x.value.cwiseProduct(y.value), inherited_error(x, y, entry_by_entry));
}

Bounded quotient(const Bounded& x, const Bounded& y) {
  const MatrixD value = x.value.cwiseQuotient(y.value);
  const MatrixD least = (y.value - y.bound).cwiseMax(0.0);
  const MatrixD error = (x.bound + value.cwiseAbs().cwiseProduct(y.bound)).cwiseQuotient(least);
  return rounded(value, error, kDivisionError);
}

Bounded square_root(const Bounded& x) {
  const MatrixD value = x.value.cwiseSqrt();
  const MatrixD high = (x.value + x.bound).cwiseSqrt(),
                low = (x.value - x.bound).cwiseMax(0.0).cwiseSqrt();
  return rounded(value, (high - value).cwiseMax(value - low), kSqrtError);
}

Bounded logarithm(const Bounded& x) {
  const MatrixD value = x.value.array().log();
  const MatrixD low = (x.value - x.bound).cwiseMax(0.0).array().log();
  return rounded(value, value - low, kLogError);
}

Bounded one_minus(const Bounded& x) {
  return Bounded::exact(constant_like(x.value, 1.0)) - x;
}

Bounded clamped(const Bounded& x, double low, double high) {
  return {x.value.cwiseMax(low).cwiseMin(high), x.bound};
}

Bounded plus_row(const Bounded& x, const Bounded& row) {
  return Sum().add(x).add_row(row).result();
}

Bounded column_sum(const Bounded& x) {
  return Sum().add_column_sum(x).result();
}

Bounded total(const Bounded& x) {
  return column_sum(column_sum(x.transposed()).transposed());
}

Bounded sigmoid(const Bounded& x) {
  return rounded(sigmoid(x.value), 0.25 * x.bound, kSigmoidError);
}

Bounded softplus(const Bounded& x) {
  // exp's error and the rounding of 1 + exp are at most those of 1; then the logarithm and the sum.
  const MatrixD own = constant_like(x.value, gamma_n(kExpError + 1.0));
  return rounded(softplus(x.value), x.bound + own, kLogError + 1.0);
}

Bounded sigmoid_gradient(const Bounded& y) {
  return times(y, one_minus(y));
}

Bounded bernoulli(const Bounded& probability, const MatrixD& uniform) {
  const auto distance = (probability.value - uniform).cwiseAbs().array();
  return {bernoulli(probability.value, uniform),
          (distance <= probability.bound.array()).cast<double>()};
}

Bounded concrete(const Bounded& probability, const MatrixD& uniform) {
  const auto draw = [&](const MatrixD& p) {
    const Eigen::ArrayXXd yes = p.array() * uniform.array();
    return MatrixD(yes / (yes + (1.0 - p.array()) * (1.0 - uniform.array())));
  };
  const MatrixD& p = probability.value;
  const MatrixD value = draw(p);
  const MatrixD high = draw((p + probability.bound).cwiseMin(1.0)),
                low = draw((p - probability.bound).cwiseMax(0.0));
  // p·u, 1 − p and the denominator are rounded (1 − u is exact), and then the division.
  return rounded(value, (high - value).cwiseMax(value - low), 3.0 + kDivisionError);
}

Bounded gaussian(const Bounded& mean, const MatrixD& normal) {
  // The root halves the logarithm's relative error; one rounding is that of the product.
  const double operations = kLogError / 2.0 + kSqrtError + kCospiError + 1.0;
  return mean + Bounded{normal, gamma_n(operations) * normal.cwiseAbs()};
}

Bounded tempered(const Bounded& mean, const Bounded& draw, double temperature) {
  const double share = std::abs(temperature);
  const MatrixD difference = draw.value - mean.value;
  // Three roundings: the difference, its product with the temperature, the sum.
  const MatrixD size = mean.value.cwiseAbs() + mean.bound +
                       share * (difference.cwiseAbs() + mean.bound + draw.bound);
  return {mean.value + temperature * difference,
          std::abs(1.0 - temperature) * mean.bound + share * draw.bound + gamma_n(3) * size};
}

}  // namespace mcdbn::reference
