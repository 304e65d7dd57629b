#include "fitting/rows_around.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace mcdbn {
namespace {

RowVectorD mean_of(const MatrixD& values, const RowsAround& around) {
  RowVectorD sum = RowVectorD::Zero(values.cols());
  double total = 0;
  Eigen::Index row = around.first;
  for (const double weight : around.weights) {
    sum += weight * values.row(row++);
    total += weight;
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

RowsAround::RowsAround(Eigen::Index rows, Eigen::Index t, double deviation_rows) {
  const auto reach = static_cast<Eigen::Index>(std::ceil(3 * deviation_rows));
  first = std::max<Eigen::Index>(0, t - reach);
  for (Eigen::Index k = first; k <= std::min(rows - 1, t + reach); ++k) {
    const double away = static_cast<double>(k - t) / deviation_rows;
    weights.push_back(std::exp(-0.5 * away * away));
  }
}

RowsAround RowsAround::without_itself(Eigen::Index rows, Eigen::Index t, double deviation_rows) {
  RowsAround around(rows, t, deviation_rows);
  around.weights[static_cast<std::size_t>(t - around.first)] = 0;
  return around;
}

RowVectorD mean_around(const MatrixD& values, Eigen::Index t, double deviation_rows) {
  return mean_of(values, RowsAround::without_itself(values.rows(), t, deviation_rows));
}

RowVectorD median_around(const MatrixD& values, Eigen::Index t, double deviation_rows) {
  const auto around = RowsAround::without_itself(values.rows(), t, deviation_rows);
  RowVectorD median(values.cols());
  std::vector<std::pair<double, double>> weighted(around.weights.size());
  for (Eigen::Index column = 0; column < values.cols(); ++column) {
    Eigen::Index row = around.first;
    for (std::size_t k = 0; k < weighted.size(); ++k) {
      weighted[k] = {values(row++, column), around.weights[k]};
    }
    median[column] = median_of(weighted);
  }
  return median;
}

MatrixD smoothed_rows(const MatrixD& values, double deviation_rows) {
  MatrixD result(values.rows(), values.cols());
  for (Eigen::Index t = 0; t < values.rows(); ++t) {
    result.row(t) = mean_of(values, RowsAround(values.rows(), t, deviation_rows));
  }
  return result;
}

}  // namespace mcdbn
