#include "by_hand.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace mcdbn::test {
namespace {

double log_weibull(double shape, double scale, double x) {
  return std::log(shape) - shape * std::log(scale) + (shape - 1) * std::log(x) -
         std::pow(x / scale, shape);
}

double log_density(const std::string& family, const std::vector<double>& p, double x) {
  const auto log_normal_density = [&](double y) {
    const double z = (y - p[0]) / p[1];
    return -z * z / 2 - std::log(p[1]) - std::log(2 * std::acos(-1.0)) / 2;
  };
  if (family == "normal") return log_normal_density(x);
  if (family == "log-normal") return log_normal_density(std::log(x)) - std::log(x);
  if (family == "gamma")
    return (p[0] - 1) * std::log(x) - x / p[1] - p[0] * std::log(p[1]) - std::lgamma(p[0]);
  if (family == "Weibull") return log_weibull(p[0], p[1], x);
  if (family == "GEV") {
    const double t = std::pow(1 + p[0] * (x - p[2]) / p[1], -1 / p[0]);
    return -std::log(p[1]) + (p[0] + 1) * std::log(t) - t;
  }
  throw std::invalid_argument(family);
}

}  // namespace

std::vector<int> counts_by_hand(const std::vector<double>& values, double low, double high,
                                int bins) {
  std::vector<int> counts(static_cast<std::size_t>(bins), 0);
  for (const double value : values)
    for (int bin = 0; bin < bins; ++bin) {
      const double from = low + (high - low) * bin / bins,
                   to = low + (high - low) * (bin + 1) / bins;
      const bool last = bin + 1 == bins;
      if (value >= from && (last ? value <= high : value < to)) {
        ++counts[static_cast<std::size_t>(bin)];
        break;
      }
    }
  return counts;
}

HandStatistics statistics_by_hand(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  HandStatistics result;
  for (const double value : values) result.mean += value / n;
  for (const double value : values)
    result.deviation += (value - result.mean) * (value - result.mean) / (n - 1);
  result.deviation = std::sqrt(result.deviation);
  const std::size_t half = values.size() / 2;
  result.median = values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
  result.minimum = values.front();
  result.maximum = values.back();
  result.counts = counts_by_hand(values, result.minimum, result.maximum, 20);
  int fullest = 0;
  for (int bin = 0; bin < 20; ++bin)
    if (result.counts[static_cast<std::size_t>(bin)] >
        result.counts[static_cast<std::size_t>(fullest)])
      fullest = bin;
  result.mode = result.minimum + (result.maximum - result.minimum) * (2 * fullest + 1) / 40;
  return result;
}

double correlation_by_hand(const MatrixD& a, const MatrixD& b) {
  const auto frames = std::min(a.rows(), b.rows());
  const double n = static_cast<double>(frames * a.cols());
  double sum_a = 0, sum_b = 0, aa = 0, bb = 0, ab = 0;
  for (Eigen::Index t = 0; t < frames; ++t)
    for (Eigen::Index c = 0; c < a.cols(); ++c) sum_a += a(t, c), sum_b += b(t, c);
  for (Eigen::Index t = 0; t < frames; ++t)
    for (Eigen::Index c = 0; c < a.cols(); ++c) {
      const double x = a(t, c) - sum_a / n, y = b(t, c) - sum_b / n;
      aa += x * x, bb += y * y, ab += x * y;
    }
  return ab / std::sqrt(aa * bb);
}

MatrixD relative_by_hand(const MatrixD& points, int joints) {
  MatrixD relative(points.rows(), 3 * (joints - 1));
  for (Eigen::Index t = 0; t < points.rows(); ++t)
    for (int column = 0; column < relative.cols(); ++column)
      relative(t, column) = points(t, column + 3) - points(t, column % 3);
  return relative;
}

double distance_by_hand(const MatrixD& a, const MatrixD& b, int joints) {
  const MatrixD difference = relative_by_hand(a, joints) - relative_by_hand(b, joints);
  double sum = 0;
  for (Eigen::Index t = 0; t < difference.rows(); ++t)
    for (int joint = 0; joint + 1 < joints; ++joint)
      sum += std::hypot(difference(t, 3 * joint), difference(t, 3 * joint + 1),
                        difference(t, 3 * joint + 2));
  return sum / static_cast<double>(difference.rows() * (joints - 1));
}

double log_likelihood_by_hand(const std::string& family, const std::vector<double>& parameters,
                              const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += log_density(family, parameters, value);
  return sum;
}

std::array<double, 2> weibull_by_hand(const std::vector<double>& values) {
  const double largest = *std::max_element(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  double mean_log = 0;
  for (const double value : values) mean_log += std::log(value / largest) / n;
  // Rises with the shape, zero at the estimate.
  const auto slope = [&](double shape) {
    double powers = 0, weighted = 0;
    for (const double value : values) {
      const double power = std::pow(value / largest, shape);
      powers += power;
      weighted += power * std::log(value / largest);
    }
    return weighted / powers - 1 / shape - mean_log;
  };
  double low = 1e-3, high = 1e6;
  for (int i = 0; i < 200; ++i) {
    const double middle = std::sqrt(low * high);
    (slope(middle) < 0 ? low : high) = middle;
  }
  double mean_power = 0;
  for (const double value : values) mean_power += std::pow(value / largest, low) / n;
  return {low, largest * std::pow(mean_power, 1 / low)};
}

std::array<double, 2> weibull_errors_by_hand(const std::array<double, 2>& fit,
                                             const std::vector<double>& values) {
  const double step[2] = {1e-4 * fit[0], 1e-4 * fit[1]};
  const auto at = [&](double i, double j) {
    return -log_likelihood_by_hand("Weibull", {fit[0] + i * step[0], fit[1] + j * step[1]}, values);
  };
  const double kk = (at(1, 0) - 2 * at(0, 0) + at(-1, 0)) / (step[0] * step[0]);
  const double ll = (at(0, 1) - 2 * at(0, 0) + at(0, -1)) / (step[1] * step[1]);
  const double kl = (at(1, 1) - at(1, -1) - at(-1, 1) + at(-1, -1)) / (4 * step[0] * step[1]);
  const double determinant = kk * ll - kl * kl;
  return {std::sqrt(ll / determinant), std::sqrt(kk / determinant)};
}

double weibull_divergence_by_hand(const std::array<double, 2>& f1,
                                  const std::array<double, 2>& f2) {
  constexpr int kSteps = 400000;
  const double end = f1[1] * std::pow(40.0, 1 / f1[0]);  // f1 is below e⁻⁴⁰ beyond
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double x = end * (i + 0.5) / kSteps;
    const double log1 = log_weibull(f1[0], f1[1], x), log2 = log_weibull(f2[0], f2[1], x);
    if (log1 > -700) sum += std::exp(log1) * (log1 - log2) * end / kSteps;
  }
  return sum;
}

}  // namespace mcdbn::test
