#pragma once

// Boost 1.74's pchip.hpp calls isnan without a namespace.
#include <math.h>  // NOLINT(modernize-deprecated-headers)

#include <Eigen/Core>
#include <boost/math/interpolators/pchip.hpp>
#include <utility>
#include <vector>

namespace mcdbn::synthesis {

/// 0 before `start`, 1 after `end`, smooth (C1) between; `end` may lie before `start` (falling).
double smooth_step(double start, double end, double t);

/// Cubic through (0, from) and (duration, to) with the slopes given per second.
template <typename Value>
Value hermite(double t, double duration, const Value& from, const Value& from_slope,
              const Value& to, const Value& to_slope) {
  const double u = t / duration;
  const double w = 1 - u;
  return (1 + 2 * u) * w * w * from + u * u * (3 - 2 * u) * to +
         duration * u * w * (w * from_slope - u * to_slope);
}

/// A curve through keys that is flat at turning points (pchip), so that it never overshoots;
/// constant before the first and after the last key.
class KeyCurve {
 public:
  using Key = std::pair<double, double>;  ///< time, value
  /// @param keys two or more, by increasing time
  explicit KeyCurve(const std::vector<Key>& keys);
  double operator()(double t) const;

 private:
  double start_, end_, first_, last_;
  boost::math::interpolators::pchip<std::vector<double>> curve_;
};

/// The same, running round a gait cycle: keys are (percent of the cycle, degrees), 0 <= percent <
/// 100.
class CyclicCurve {
 public:
  explicit CyclicCurve(const std::vector<KeyCurve::Key>& keys);
  /// @param phase in cycles, any real number
  double operator()(double phase) const;

 private:
  KeyCurve curve_;
};

}  // namespace mcdbn::synthesis
