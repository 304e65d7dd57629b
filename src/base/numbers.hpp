#pragma once

#include <limits>
#include <numbers>

namespace mcdbn {

/// An unknown value: a hidden joint, a mean of no values.
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

inline constexpr double kRadiansPerDegree = std::numbers::pi / 180;

}  // namespace mcdbn
