#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mcdbn {

/// A stationary process of variance 1 that changes slowly, as an energy by frame:
///   E = ½ Σ value_weight · x(t)² + curvature_weight · (x(t−1) − 2 x(t) + x(t+1))²
/// In continuous time its spectral density is 1 / (a · (1 + (s ω)⁴)), a the value's weight. Its
/// integral over ω / 2π, the variance, is 1 / (2 √2 a s). So frames within the time s count as
/// about one.
struct SlowProcess {
  double value_weight, curvature_weight;

  /// @param time_s the time s; the correlation has fallen to 0.70 after it, to 0 after 3.3 of it
  SlowProcess(double time_s, double frame_time_s) {
    const double frames = std::max(1.0, time_s / frame_time_s);
    value_weight = 1 / (2 * std::numbers::sqrt2 * frames);
    curvature_weight = value_weight * std::pow(frames, 4);
  }
};

}  // namespace mcdbn
