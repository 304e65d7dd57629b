#pragma once

#include <vector>

namespace mcdbn {

/// Bins of equal width; the last one holds its upper border too.
struct Histogram {
  double low = 0, high = 0;
  std::vector<int> counts;

  double bin_width() const;
  double bin_centre(int bin) const;
};

/// The columns of the paper's Tables 3 and 6, and what its figures 8 and 11 draw.
struct SummaryStatistics {
  int count = 0;     ///< finite values
  int left_out = 0;  ///< values that are not finite: they are in no figure below
  /// NaN without a finite value, the deviation also with only one.
  double mean = 0, standard_deviation = 0;  ///< deviation of a sample: n − 1
  double mode = 0;                          ///< centre of the fullest bin, the lowest of equals
  double median = 0, minimum = 0, maximum = 0;
  Histogram histogram;  ///< from minimum to maximum; no bins without a finite value
};

/// @throws ConfigError unless bins > 0
SummaryStatistics summarize(const std::vector<double>& values, int bins);

/// Counts over a range of one's own, so that two histograms can be drawn over each other. What lies
/// outside of it, or is NaN, is not counted. @throws ConfigError unless bins > 0 and low <= high
Histogram histogram_of(const std::vector<double>& values, double low, double high, int bins);

}  // namespace mcdbn
