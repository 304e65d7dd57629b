#include "evaluation/summary_statistics.hpp"

#include <fmt/core.h>

#include <Eigen/Core>
#include <algorithm>
#include <boost/math/statistics/univariate_statistics.hpp>
#include <cmath>
#include <iterator>

#include "base/numbers.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

double mode_of(const Histogram& histogram) {
  const auto fullest = std::max_element(histogram.counts.begin(), histogram.counts.end());
  return histogram.bin_centre(static_cast<int>(fullest - histogram.counts.begin()));
}

}  // namespace

double Histogram::bin_width() const {
  return (high - low) / static_cast<double>(counts.size());
}

double Histogram::bin_centre(int bin) const {
  return low + (bin + 0.5) * bin_width();
}

Histogram histogram_of(const std::vector<double>& values, double low, double high, int bins) {
  if (bins <= 0 || !(low <= high))
    throw ConfigError(fmt::format("no histogram of {} bins from {} to {}", bins, low, high));
  Histogram histogram{low, high, std::vector<int>(static_cast<std::size_t>(bins))};
  for (const double value : values) {
    if (!(value >= low && value <= high)) continue;
    const double position = high > low ? (value - low) / (high - low) * bins : 0;
    ++histogram.counts[static_cast<std::size_t>(std::min(static_cast<int>(position), bins - 1))];
  }
  return histogram;
}

SummaryStatistics summarize(const std::vector<double>& values, int bins) {
  std::vector<double> sorted;
  std::copy_if(values.begin(), values.end(), std::back_inserter(sorted),
               [](double value) { return std::isfinite(value); });
  std::sort(sorted.begin(), sorted.end());
  SummaryStatistics summary;
  summary.count = static_cast<int>(sorted.size());
  summary.left_out = static_cast<int>(values.size() - sorted.size());
  if (sorted.empty()) {
    summary.mean = summary.standard_deviation = summary.mode = kNan;
    summary.median = summary.minimum = summary.maximum = kNan;
    return summary;
  }
  const Eigen::Map<const Eigen::ArrayXd> x(sorted.data(), summary.count);
  summary.mean = x.mean();
  summary.standard_deviation =
      summary.count > 1 ? std::sqrt((x - summary.mean).square().sum() / (summary.count - 1)) : kNan;
  summary.minimum = sorted.front();
  summary.maximum = sorted.back();
  summary.histogram = histogram_of(sorted, summary.minimum, summary.maximum, bins);
  summary.mode = mode_of(summary.histogram);
  // Last: it reorders the values.
  summary.median = boost::math::statistics::median(sorted.begin(), sorted.end());
  return summary;
}

}  // namespace mcdbn
