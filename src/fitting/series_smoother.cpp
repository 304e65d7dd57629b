#include "fitting/series_smoother.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "fitting/robust_residuals.hpp"

namespace mcdbn {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::infinity();
constexpr int kReweightings = 3;
/// The variance of an unknown number, in pixels or on rays.
constexpr double kAnything = 1e8;

/// A number and its rate of change.
struct State {
  Eigen::Vector2d mean{0, 0};
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();

  Measured number() const { return {mean[0], covariance(0, 0)}; }
};

State updated(const State& state, const Measured& measured) {
  if (std::isinf(measured.variance)) return state;
  const Eigen::Vector2d gain =
      state.covariance.col(0) / (state.covariance(0, 0) + measured.variance);
  return {state.mean + gain * (measured.value - state.mean[0]),
          state.covariance - gain * state.covariance.row(0)};
}

std::vector<State> posterior(const std::vector<Measured>& series, const SeriesDynamics& dynamics) {
  std::vector<State> predicted(series.size()), states(series.size());
  for (std::size_t t = 0; t < series.size(); ++t) {
    predicted[t].covariance = dynamics.start;
    if (t > 0) {
      predicted[t].mean = dynamics.step * states[t - 1].mean;
      predicted[t].covariance =
          dynamics.step * states[t - 1].covariance * dynamics.step.transpose() + dynamics.noise;
    }
    states[t] = updated(predicted[t], series[t]);
  }
  for (std::size_t t = series.size(); t-- > 1;) {
    const Eigen::Matrix2d gain =
        states[t - 1].covariance * dynamics.step.transpose() * predicted[t].covariance.inverse();
    states[t - 1].mean += gain * (states[t].mean - predicted[t].mean);
    states[t - 1].covariance +=
        gain * (states[t].covariance - predicted[t].covariance) * gain.transpose();
  }
  return states;
}

/// How much a measurement counts, 0 to 1, by its residual from the estimate of the others.
double weight_of(const Measured& measured, const Measured& used, const State& state) {
  const Measured others = without(state.number(), used);
  if (std::isinf(others.variance)) return 1;
  const double residual =
      (measured.value - others.value) / (kCauchy * std::sqrt(measured.variance + others.variance));
  return 1 / (1 + residual * residual);
}

}  // namespace

SeriesDynamics SeriesDynamics::with_velocity(double density, double frame_time_s) {
  const double time = frame_time_s;
  SeriesDynamics result;
  result.start << kAnything, 0, 0, kAnything;
  result.step << 1, time, 0, 1;
  result.noise << time * time * time / 3, time * time / 2, time * time / 2, time;
  result.noise *= density;
  return result;
}

Measured without(const Measured& whole, const Measured& part) {
  const double information = 1 / whole.variance - 1 / part.variance;
  if (!(information > 1e-9 / whole.variance)) return {0, kUnknown};
  const double taken = std::isinf(part.variance) ? 0 : part.value / part.variance;
  return {(whole.value / whole.variance - taken) / information, 1 / information};
}

std::vector<Measured> smooth_series(const std::vector<Measured>& series,
                                    const SeriesDynamics& dynamics) {
  std::vector<Measured> used = series;
  std::vector<State> states = posterior(used, dynamics);
  for (int round = 1; round < kReweightings; ++round) {
    for (std::size_t t = 0; t < series.size(); ++t) {
      if (std::isinf(series[t].variance)) continue;
      used[t].variance = series[t].variance / weight_of(series[t], used[t], states[t]);
    }
    states = posterior(used, dynamics);
  }
  std::vector<Measured> result;
  result.reserve(states.size());
  for (const State& state : states) result.push_back(state.number());
  return result;
}

}  // namespace mcdbn
