#include "camera/confidence_weights.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/upper_median.hpp"

namespace mcdbn {
namespace {

constexpr double kPower = 2.5, kMost = 1.5;

/// Confidences above this share of the highest are of joints that the camera sees.
constexpr double kOfVisible = 0.5;
/// The highest, but for outliers: that many are below it.
constexpr double kHighest = 0.9;

/// The median of visible joints' confidences; 0 where nothing is above 0. Where most of a body lies
/// outside of the image, hidden joints would else give the scale.
double usual_confidence(const MatrixD& confidence) {
  std::vector<double> seen;
  std::ranges::copy_if(confidence.reshaped(), std::back_inserter(seen),
                       [](double value) { return value > 0; });
  if (seen.empty()) return 0;
  const auto highest = seen.begin() + static_cast<std::ptrdiff_t>(kHighest * (seen.size() - 1));
  std::ranges::nth_element(seen, highest);
  const double visible = kOfVisible * *highest;
  std::erase_if(seen, [&](double value) { return value < visible; });
  return upper_median(std::move(seen));
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
