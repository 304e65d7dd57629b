#include "mcdbn/evaluation/pearson.hpp"

#include <fmt/core.h>

#include <cmath>

#include "base/numbers.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

constexpr double kRounding = 1e-9;

template <typename Derived>
bool changes(const Eigen::MatrixBase<Derived>& values, double magnitude) {
  return values.maxCoeff() - values.minCoeff() > kRounding * magnitude;
}

void check_same_shape(const MatrixD& a, const MatrixD& b) {
  if (a.rows() != b.rows() || a.cols() != b.cols() || a.size() == 0)
    throw ShapeError(fmt::format("cannot correlate clips of {}x{} and {}x{}", a.rows(), a.cols(),
                                 b.rows(), b.cols()));
}

/// Means are taken out first: the one-pass formula loses everything where the mean is large. No
/// temporaries, as pairwise figures come here hundreds of thousands of times.
double correlation(const Eigen::Ref<const Eigen::VectorXd>& x,
                   const Eigen::Ref<const Eigen::VectorXd>& y) {
  const auto dx = x.array() - x.mean();
  const auto dy = y.array() - y.mean();
  return (dx * dy).sum() / std::sqrt(dx.square().sum() * dy.square().sum());
}

Eigen::Map<const Eigen::VectorXd> flattened(const MatrixD& clip) {
  return {clip.data(), clip.size()};
}

}  // namespace

double pearson(const Eigen::Ref<const Eigen::VectorXd>& x,
               const Eigen::Ref<const Eigen::VectorXd>& y) {
  if (x.size() != y.size() || x.size() == 0)
    throw ShapeError(fmt::format("cannot correlate {} with {} values", x.size(), y.size()));
  if (!std::isfinite(x.sum()) || !std::isfinite(y.sum())) return kNan;
  if (!changes(x, x.cwiseAbs().maxCoeff()) || !changes(y, y.cwiseAbs().maxCoeff())) return kNan;
  return correlation(x, y);
}

double pearson_flat(const MatrixD& truth, const MatrixD& regenerated) {
  check_same_shape(truth, regenerated);
  return pearson(flattened(truth), flattened(regenerated));
}

double pearson_per_channel(const MatrixD& truth, const MatrixD& regenerated) {
  check_same_shape(truth, regenerated);
  if (!truth.allFinite() || !regenerated.allFinite()) return kNan;
  const double truth_magnitude = truth.cwiseAbs().maxCoeff();
  const double regenerated_magnitude = regenerated.cwiseAbs().maxCoeff();
  double sum = 0;
  int counted = 0;
  for (Eigen::Index column = 0; column < truth.cols(); ++column) {
    if (!changes(truth.col(column), truth_magnitude)) continue;
    ++counted;
    if (changes(regenerated.col(column), regenerated_magnitude))
      sum += correlation(truth.col(column), regenerated.col(column));
  }
  return counted ? sum / counted : kNan;
}

}  // namespace mcdbn
