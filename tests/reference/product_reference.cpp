#include "reference/product_reference.hpp"

namespace mcdbn::reference {
namespace {

Bounded constant_like(const MatrixD& x, double value) {
  return Bounded::exact(MatrixD::Constant(x.rows(), x.cols(), value));
}

}  // namespace

Bounded product(const MatrixD& a, const MatrixD& b, double alpha, double beta, const MatrixD& c) {
  Sum sum;
  sum.add_product(Bounded::exact(a), Bounded::exact(b)).scale(alpha);
  if (beta != 0.0) sum.add(Bounded::exact(beta * c));
  return sum.result();
}

Bounded relu(const Bounded& x) {
  return {x.value.cwiseMax(0.0), x.bound};
}

Bounded relu_gradient(const Bounded& x, const MatrixD& y) {
  const MatrixD open = (y.array() > 0.0).cast<double>();
  return {x.value.cwiseProduct(open), x.bound.cwiseProduct(open)};
}

Bounded centered_sigmoid(const Bounded& x) {
  return sigmoid(x) - constant_like(x.value, 0.5);
}

Bounded centered_sigmoid_gradient(const Bounded& x, const MatrixD& y, double kept_share) {
  const Bounded units = kept_share * Bounded::exact(y);
  const Bounded slope = divided(constant_like(y, 0.25) - times(units, units), kept_share);
  const MatrixD open = kept_share < 1.0 ? MatrixD((y.array() != 0.0).cast<double>())
                                        : MatrixD::Ones(y.rows(), y.cols());
  return times(x, {slope.value.cwiseProduct(open), slope.bound.cwiseProduct(open)});
}

}  // namespace mcdbn::reference
