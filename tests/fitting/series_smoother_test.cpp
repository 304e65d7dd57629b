#include "fitting/series_smoother.hpp"

#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

using namespace mcdbn;

namespace {
constexpr double kUnseen = std::numeric_limits<double>::infinity();
}

TEST_CASE("the smoother's variances are those of the Gaussian process, solved densely") {
  constexpr double kStart = 4, kStartRate = 9, kDensity = 100, kFrame_s = 1.0 / 30;
  std::vector<Measured> series(20, {0, 0.3});
  for (const int gap : {0, 5, 6, 7, 8, 9, 15}) series[gap].variance = kUnseen;
  series[11].variance = 2;
  SeriesDynamics dynamics = SeriesDynamics::with_velocity(kDensity, kFrame_s);
  dynamics.start.diagonal() << kStart, kStartRate;
  const auto smoothed = smooth_series(series, dynamics);
  // A start, a rate, and twice integrated white noise.
  const auto kernel = [&](int a, int b) {
    const double before = std::min(a, b) * kFrame_s, after = std::max(a, b) * kFrame_s;
    return kStart + kStartRate * before * after +
           kDensity * before * before * (3 * after - before) / 6;
  };
  Eigen::MatrixXd all(20, 20);
  for (int a = 0; a < 20; ++a) {
    for (int b = 0; b < 20; ++b) all(a, b) = kernel(a, b);
  }
  std::vector<int> seen;
  for (int t = 0; t < 20; ++t) {
    if (std::isfinite(series[t].variance)) seen.push_back(t);
  }
  Eigen::MatrixXd measured = all(seen, seen);
  for (std::size_t k = 0; k < seen.size(); ++k) {
    measured(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(k)) +=
        series[seen[k]].variance;
  }
  const Eigen::MatrixXd cross = all(Eigen::all, seen);
  const Eigen::MatrixXd posterior = all - cross * measured.llt().solve(cross.transpose());
  for (int t = 0; t < 20; ++t) {
    CAPTURE(t);
    CHECK(smoothed[t].variance == doctest::Approx(posterior(t, t)).epsilon(1e-9));
    CHECK(smoothed[t].value == 0);
  }
}

TEST_CASE("the smoother follows a line through a gap and lets go of a spike") {
  std::vector<Measured> series;
  for (int t = 0; t < 40; ++t) series.push_back({5.0 * t, t >= 20 && t < 26 ? kUnseen : 1.0});
  const auto dynamics = SeriesDynamics::with_velocity(100, 1.0 / 30);
  const auto line = smooth_series(series, dynamics);
  for (int t = 0; t < 40; ++t) CHECK(line[t].value == doctest::Approx(5.0 * t).epsilon(1e-5));
  CHECK(line[23].variance > line[20].variance);
  CHECK(line[20].variance > line[10].variance);
  series[10].value += 1000;
  // 1000 deviations off: Cauchy's weight leaves it a pull of some hundredths.
  CHECK(std::abs(smooth_series(series, dynamics)[10].value - 50) < 0.1);
}

TEST_CASE("a belief without its part is the other part") {
  const Measured a{3, 2}, b{-1, 0.5};
  const double information = 1 / a.variance + 1 / b.variance;
  const Measured both{(a.value / a.variance + b.value / b.variance) / information, 1 / information};
  CHECK(without(both, b).value == doctest::Approx(a.value));
  CHECK(without(both, b).variance == doctest::Approx(a.variance));
  CHECK(std::isinf(without(a, a).variance));
}
