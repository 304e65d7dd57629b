#include "rows_around.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace mcdbn {
namespace {

/// A Gaussian around one row, cut off where it is next to nothing.
struct Around {
  Around(Eigen::Index rows, Eigen::Index t, double deviation_rows)
      : middle(t), deviation(deviation_rows) {
    const auto reach = static_cast<Eigen::Index>(std::ceil(3 * deviation));
    first = std::max<Eigen::Index>(0, t - reach);
    last = std::min(rows - 1, t + reach);
  }
  double weight(Eigen::Index k) const {
    const double away = static_cast<double>(k - middle) / deviation;
    return std::exp(-0.5 * away * away);
  }

  Eigen::Index middle, first, last;
  double deviation;
};

RowVectorD mean_of(const MatrixD& values, const Around& around, bool itself) {
  RowVectorD sum = RowVectorD::Zero(values.cols());
  double total = 0;
  for (Eigen::Index k = around.first; k <= around.last; ++k) {
    if (k == around.middle && !itself) continue;
    sum += around.weight(k) * values.row(k);
    total += around.weight(k);
  }
  return sum / total;
}

/// @param weighted value and weight, at least one
double median_of(std::vector<std::pair<double, double>>& weighted) {
  std::sort(weighted.begin(), weighted.end());
  double total = 0, below = 0;
  for (const auto& [value, weight] : weighted) total += weight;
  for (const auto& [value, weight] : weighted) {
    below += weight;
    if (below >= total / 2) return value;
  }
  return weighted.back().first;
}

}  // namespace

RowVectorD mean_around(const MatrixD& values, Eigen::Index t, double deviation_rows) {
  return mean_of(values, Around(values.rows(), t, deviation_rows), false);
}

RowVectorD median_around(const MatrixD& values, Eigen::Index t, double deviation_rows) {
  const Around around(values.rows(), t, deviation_rows);
  RowVectorD median(values.cols());
  std::vector<std::pair<double, double>> weighted;
  for (Eigen::Index column = 0; column < values.cols(); ++column) {
    weighted.clear();
    for (Eigen::Index k = around.first; k <= around.last; ++k) {
      if (k != t) weighted.emplace_back(values(k, column), around.weight(k));
    }
    median[column] = median_of(weighted);
  }
  return median;
}

MatrixD smoothed_rows(const MatrixD& values, double deviation_rows) {
  MatrixD result(values.rows(), values.cols());
  for (Eigen::Index t = 0; t < values.rows(); ++t) {
    result.row(t) = mean_of(values, Around(values.rows(), t, deviation_rows), true);
  }
  return result;
}

}  // namespace mcdbn
