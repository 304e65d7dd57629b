#include "camera/confidence_weights.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/upper_median.hpp"

namespace mcdbn {
namespace {

constexpr double kPower = 2.5, kMost = 1.5;

/// The median of what is above 0; 0 where nothing is.
double usual_confidence(const MatrixD& confidence) {
  std::vector<double> seen;
  std::ranges::copy_if(confidence.reshaped(), std::back_inserter(seen),
                       [](double value) { return value > 0; });
  return seen.empty() ? 0 : upper_median(std::move(seen));
}

}  // namespace

Track2d weighted_by_confidence(const Track2d& track) {
  Track2d result = track;
  const double usual = usual_confidence(track.confidence);
  if (!(usual > 0)) return result;
  for (double& value : result.confidence.reshaped())
    value = value > 0 ? std::min(kMost, std::pow(value / usual, kPower)) : 0;
  return result;
}

}  // namespace mcdbn
