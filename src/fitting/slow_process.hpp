#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mcdbn {

/// A stationary process of variance 1 that changes slowly, as an energy by frame:
///   E = ½ Σ point · x(t)² + bend · (x(t−1) − 2 x(t) + x(t+1))²
/// In continuous time its spectral density is 1 / (a · (1 + (s ω)⁴)), whose integral over ω / 2π,
/// the variance, is 1 / (2 √2 a s). So frames within the time s count as about one.
struct SlowProcess {
  double point, bend;

  /// @param lasting_s the time s; the correlation has fallen to 0.70 after it, to 0 after 3.3 of it
  SlowProcess(double lasting_s, double frame_time_s) {
    const double frames = std::max(1.0, lasting_s / frame_time_s);
    point = 1 / (2 * std::numbers::sqrt2 * frames);
    bend = point * std::pow(frames, 4);
  }
};

}  // namespace mcdbn
