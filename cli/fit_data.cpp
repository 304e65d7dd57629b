#include "fit_data.hpp"

#include <fmt/format.h>

#include <cmath>

#include "learning/unit_values.hpp"

namespace mcdbn::cli {

ColumnScale prepare(std::vector<MatrixF>& data, const MatrixInput& files, VisibleKind kind,
                    bool standardize) {
  for (std::size_t i = 0; i < data.size(); ++i)
    check_unit_values(data[i], kind, files.files[i].string());
  if (!standardize || kind == VisibleKind::binary) return {};
  ColumnScale scale = ColumnScale::of(data);
  for (MatrixF& values : data) values = scale.apply(values);
  return scale;
}

std::string far_from_standardized(const std::vector<MatrixF>& data, const MatrixInput& files,
                                  bool learns_deviation) {
  // In the units' own deviations.
  constexpr float kLargestMean = 3, kLeastDeviation = 0.2F, kLargestDeviation = 5;
  const ColumnScale found = ColumnScale::of(data);
  for (Eigen::Index c = 0; c < found.mean.cols(); ++c) {
    const float mean = found.mean(c), deviation = found.deviation(c);
    const bool other_deviation = deviation < kLeastDeviation || deviation > kLargestDeviation;
    if (std::abs(mean) <= kLargestMean && (learns_deviation || !other_deviation)) continue;
    const std::size_t more = files.files.size() - 1;
    return fmt::format(
        "{}{}: column {} has mean {:.3g} and deviation {:.3g}; Gaussian units need 0 and 1: give "
        "--standardize",
        files.files.front().string(), more > 0 ? fmt::format(" and {} more", more) : "", c + 1,
        mean, deviation);
  }
  return {};
}

}  // namespace mcdbn::cli
