#pragma once

#include <cmath>
#include <concepts>
#include <numbers>

/// Shares of a learning rate that falls over a training.
namespace mcdbn {

/// Share of most rates that is left at the end.
inline constexpr double kFinalRate = 0.02;

/// From 1 to kFinalRate in a straight line, in the precision of its argument. @param progress 0 … 1
template <std::floating_point Real>
Real linear_fall(Real progress) {
  return Real{1} - static_cast<Real>(1.0 - kFinalRate) * progress;
}

/// From 1 to `final_rate` along half a cosine. @param progress 0 … 1
inline double cosine_fall(double progress, double final_rate = kFinalRate) {
  return final_rate + (1.0 - final_rate) * 0.5 * (1.0 + std::cos(std::numbers::pi * progress));
}

}  // namespace mcdbn
