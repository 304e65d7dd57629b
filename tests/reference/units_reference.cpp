#include "reference/units_reference.hpp"

#include <cmath>

namespace mcdbn::reference {

double sigmoid(double x) {
  if (x >= 0) return 1.0 / (1.0 + std::exp(-x));
  const double e = std::exp(x);
  return e / (1.0 + e);
}

MatrixD sigmoid(const MatrixD& x) {
  return x.unaryExpr([](double value) { return sigmoid(value); });
}

double softplus(double x) {
  return std::max(x, 0.0) + std::log1p(std::exp(-std::abs(x)));
}

MatrixD softplus(const MatrixD& x) {
  return x.unaryExpr([](double value) { return softplus(value); });
}

MatrixD bernoulli(const MatrixD& probability, const MatrixD& uniform) {
  return (uniform.array() < probability.array()).cast<double>();
}

double closest_draw(const MatrixD& probability, const MatrixD& uniform) {
  return (probability - uniform).cwiseAbs().minCoeff();
}

MatrixD plus_row(const MatrixD& x, const RowVectorD& row) {
  return x.rowwise() + row;
}

double cross_entropy_of_sigmoid(const MatrixD& target, const MatrixD& x) {
  double sum = 0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    // log(1 + e^x) − t·x
    sum += softplus(x.data()[i]) - target.data()[i] * x.data()[i];
  }
  return sum;
}

}  // namespace mcdbn::reference
