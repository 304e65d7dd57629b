#include "mcdbn/features/standardizer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/json_place.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {

namespace {

void require_columns(Eigen::Index columns, Eigen::Index expected, const char* what) {
  if (columns != expected) {
    throw ShapeError(
        fmt::format("Standardizer::{}: {} columns, expected {}", what, columns, expected));
  }
}

/// Calls use(value) for every number of one column.
template <typename Use>
void for_each_number(const std::vector<const MatrixD*>& blocks, Eigen::Index column, Use use) {
  for (const MatrixD* block : blocks) {
    for (Eigen::Index row = 0; row < block->rows(); ++row) {
      const double value = (*block)(row, column);
      if (!std::isnan(value)) use(value);
    }
  }
}

struct ColumnScale {
  double mean = 0, deviation = 0;
};

ColumnScale column_scale(const std::vector<const MatrixD*>& blocks, Eigen::Index column) {
  double sum = 0, lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  Eigen::Index count = 0;
  for_each_number(blocks, column, [&](double value) {
    sum += value;
    lowest = std::min(lowest, value);
    highest = std::max(highest, value);
    ++count;
  });
  if (count == 0) return {};
  // The mean of equal numbers may differ from them in the last bit; constants must come back
  // exactly.
  if (lowest == highest) return {lowest, 0};
  const double mean = sum / static_cast<double>(count);
  double squares = 0;
  for_each_number(blocks, column,
                  [&](double value) { squares += (value - mean) * (value - mean); });
  return {mean, std::sqrt(squares / static_cast<double>(count))};
}

}  // namespace

Standardizer Standardizer::fit(const std::vector<const MatrixD*>& blocks) {
  if (blocks.empty()) throw ShapeError("Standardizer::fit: no blocks");
  const Eigen::Index columns = blocks.front()->cols();
  for (const MatrixD* block : blocks) require_columns(block->cols(), columns, "fit");
  Standardizer result;
  result.mean_.resize(columns);
  result.deviation_.resize(columns);
  for (Eigen::Index column = 0; column < columns; ++column) {
    const ColumnScale scale = column_scale(blocks, column);
    result.mean_[column] = scale.mean;
    result.deviation_[column] = scale.deviation;
    if (scale.deviation >= kSmallestDeviation) result.kept_.push_back(static_cast<int>(column));
  }
  return result;
}

MatrixF Standardizer::apply(const MatrixD& values) const {
  require_columns(values.cols(), mean_.size(), "apply");
  MatrixF result(values.rows(), output_dimension());
  for (int k = 0; k < output_dimension(); ++k) {
    const int column = kept_[k];
    result.col(k) =
        ((values.col(column).array() - mean_[column]) / deviation_[column]).cast<float>();
  }
  return result;
}

MatrixD Standardizer::invert(const MatrixF& standardized) const {
  require_columns(standardized.cols(), output_dimension(), "invert");
  MatrixD result = mean_.replicate(standardized.rows(), 1);
  for (int k = 0; k < output_dimension(); ++k) {
    result.col(kept_[k]) += standardized.col(k).cast<double>() * deviation_[kept_[k]];
  }
  return result;
}

nlohmann::json Standardizer::to_json() const {
  return {{"mean", std::vector<double>(mean_.begin(), mean_.end())},
          {"deviation", std::vector<double>(deviation_.begin(), deviation_.end())},
          {"kept", kept_}};
}

Standardizer Standardizer::from_json(const nlohmann::json& json, const std::string& where) {
  const JsonPlace place(json, where);
  const auto row = [&](const char* name) -> RowVectorD {
    const std::vector<double> values = place[name].finite_numbers();
    return RowVectorD::Map(values.data(), static_cast<Eigen::Index>(values.size()));
  };
  Standardizer result;
  result.mean_ = row("mean");
  result.deviation_ = row("deviation");
  if (result.deviation_.size() != result.mean_.size())
    place["deviation"].fail(
        fmt::format("{} numbers, but mean has {}", result.deviation_.size(), result.mean_.size()));
  const Range columns = within(0, static_cast<double>(result.mean_.size()) - 1);
  for (const JsonPlace& kept : place["kept"].list()) {
    const int column = static_cast<int>(kept.count(columns));
    if (!result.kept_.empty() && column <= result.kept_.back())
      kept.fail("columns do not rise; the model file is damaged");
    if (!(result.deviation_[column] > 0))
      kept.fail("a column whose deviation is not above 0; the model file is damaged");
    result.kept_.push_back(column);
  }
  return result;
}

}  // namespace mcdbn
