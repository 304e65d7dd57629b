#pragma once

#include <limits>
#include <numbers>

namespace mcdbn {

/// What is not known: a joint out of sight, a mean of nothing.
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

inline constexpr double kRadiansPerDegree = std::numbers::pi / 180;

}  // namespace mcdbn
