#include "synthesis/synthesize_curves.hpp"

#include <algorithm>
#include <cmath>

namespace mcdbn::synthesis {
namespace {

using Pchip = boost::math::interpolators::pchip<std::vector<double>>;

Pchip fit(const std::vector<KeyCurve::Key>& keys) {
  // Boost wants four points and slopes at the ends: flat run-outs on both sides give it both.
  constexpr double kRunOut = 1.0;
  std::vector<double> times{keys.front().first - kRunOut};
  std::vector<double> values{keys.front().second};
  for (const auto& [time, value] : keys) {
    times.push_back(time);
    values.push_back(value);
  }
  times.push_back(keys.back().first + kRunOut);
  values.push_back(keys.back().second);
  return Pchip(std::move(times), std::move(values), 0.0, 0.0);
}

/// Keys of the cycle before and after, so that the curve joins itself smoothly at 0 and 100 %.
std::vector<KeyCurve::Key> wrapped(const std::vector<KeyCurve::Key>& keys) {
  std::vector<KeyCurve::Key> result;
  for (const double shift : {-1.0, 0.0, 1.0}) {
    for (const auto& [percent, value] : keys) result.emplace_back(percent / 100 + shift, value);
  }
  return result;
}

}  // namespace

double smooth_step(double start, double end, double t) {
  const double u = std::clamp((t - start) / (end - start), 0.0, 1.0);
  return u * u * (3 - 2 * u);
}

KeyCurve::KeyCurve(const std::vector<Key>& keys)
    : start_(keys.front().first),
      end_(keys.back().first),
      first_(keys.front().second),
      last_(keys.back().second),
      curve_(fit(keys)) {}

double KeyCurve::operator()(double t) const {
  if (t <= start_) return first_;
  if (t >= end_) return last_;
  return curve_(t);
}

CyclicCurve::CyclicCurve(const std::vector<KeyCurve::Key>& keys) : curve_(wrapped(keys)) {}

double CyclicCurve::operator()(double phase) const {
  return curve_(phase - std::floor(phase));
}

}  // namespace mcdbn::synthesis
