#include "reference/running_error.hpp"

#include "reference/error_bounds.hpp"
#include "reference/units_reference.hpp"

namespace mcdbn::reference {
namespace {

/// The bound of an inexact operand's operation plus the rounding of its own result.
Bounded rounded(const MatrixD& value, const MatrixD& error, double operations = 1.0) {
  const MatrixD largest = value.cwiseAbs() + error;
  return {value, error + gamma_n(operations) * largest +
                     MatrixD::Constant(value.rows(), value.cols(), kSmallestNormal)};
}

}  // namespace

Bounded Bounded::exact(const MatrixD& value) {
  return {value, MatrixD::Zero(value.rows(), value.cols())};
}

Bounded operator+(const Bounded& x, const Bounded& y) {
  return rounded(x.value + y.value, x.bound + y.bound);
}

Bounded operator-(const Bounded& x, const Bounded& y) {
  return rounded(x.value - y.value, x.bound + y.bound);
}

Bounded operator*(double exact, const Bounded& x) {
  // Twice, as the factor itself may be rounded.
  return rounded(exact * x.value, std::abs(exact) * x.bound, 2.0);
}

Bounded product(const Bounded& x, const Bounded& y) {
  const MatrixD x_size = x.value.cwiseAbs() + x.bound;
  const MatrixD y_size = y.value.cwiseAbs() + y.bound;
  const MatrixD inherited = x_size * y.bound + x.bound * y.value.cwiseAbs();
  const double operations = static_cast<double>(x.value.cols()) + 2.0;
  const MatrixD tiny = MatrixD::Constant(x.value.rows(), y.value.cols(), kSmallestNormal);
  return {x.value * y.value, inherited + gamma_n(operations) * (x_size * y_size) +
                                 static_cast<double>(x.value.cols()) * tiny};
}

Bounded times(const Bounded& x, const Bounded& y) {
  const MatrixD inherited = (x.value.cwiseAbs() + x.bound).cwiseProduct(y.bound) +
                            x.bound.cwiseProduct(y.value.cwiseAbs());
  return rounded(x.value.cwiseProduct(y.value), inherited);
}

Bounded plus_row(const Bounded& x, const Bounded& row) {
  return x +
         Bounded{row.value.replicate(x.value.rows(), 1), row.bound.replicate(x.value.rows(), 1)};
}

Bounded column_sum(const Bounded& x) {
  return product(Bounded::exact(MatrixD::Ones(1, x.value.rows())), x);
}

Bounded sigmoid(const Bounded& x) {
  return rounded(sigmoid(x.value), 0.25 * x.bound, kSigmoidError);
}

Bounded sigmoid_gradient(const Bounded& y) {
  return times(y, Bounded::exact(MatrixD::Ones(y.value.rows(), y.value.cols())) - y);
}

Bounded bernoulli(const Bounded& probability, const MatrixD& uniform) {
  const auto distance = (probability.value - uniform).cwiseAbs().array();
  return {(uniform.array() < probability.value.array()).cast<double>(),
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
  return {value, (high - value).cwiseMax(value - low) + gamma_n(6) * value};
}

}  // namespace mcdbn::reference
