#include "mcdbn/features/standardizer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

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

Standardizer Standardizer::from_json(const nlohmann::json& json) {
  Standardizer result;
  try {
    const auto mean = json.at("mean").get<std::vector<double>>();
    const auto deviation = json.at("deviation").get<std::vector<double>>();
    result.mean_ = RowVectorD::Map(mean.data(), static_cast<Eigen::Index>(mean.size()));
    result.deviation_ =
        RowVectorD::Map(deviation.data(), static_cast<Eigen::Index>(deviation.size()));
    result.kept_ = json.at("kept").get<std::vector<int>>();
  } catch (const nlohmann::json::exception& error) {
    throw InputError(fmt::format("scaling: {}; the model file is damaged", error.what()));
  }
  const int columns = result.input_dimension();
  const auto usable = [&](int column) {
    return column >= 0 && column < columns && result.deviation_[column] > 0;
  };
  if (result.deviation_.size() != columns ||
      !std::all_of(result.kept_.begin(), result.kept_.end(), usable)) {
    throw InputError("scaling: sizes that do not fit together; the model file is damaged");
  }
  return result;
}

}  // namespace mcdbn
