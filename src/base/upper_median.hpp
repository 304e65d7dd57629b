#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace mcdbn {

/// The middle value by size; of an even number of them the upper of the two in the middle.
/// @param values one at least
inline double upper_median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace mcdbn
