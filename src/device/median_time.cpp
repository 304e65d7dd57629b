#include "device/median_time.hpp"

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

#include "base/upper_median.hpp"

namespace mcdbn {
namespace {

using Clock = std::chrono::steady_clock;

double since_s(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Seconds a run, of so many.
double mean_time_s(Device& device, const std::function<void()>& run, std::size_t runs) {
  device.finish();
  const auto start = Clock::now();
  for (std::size_t i = 0; i < runs; ++i) run();
  device.finish();
  return since_s(start) / static_cast<double>(runs);
}

}  // namespace

double median_time_s(Device& device, const std::function<void()>& run, double seconds) {
  constexpr double kSample_s = 0.01;  // long enough that the clock and the queue's end do not count
  constexpr double kMostRuns = 1000;  // so that a run of no time ends
  constexpr std::size_t kFewestSamples = 5;  // their median is not moved by one that was disturbed
  const double once_s = mean_time_s(device, run, 1);
  if (seconds == 0) return once_s;
  const auto runs = static_cast<std::size_t>(std::clamp(kSample_s / once_s, 1.0, kMostRuns));
  std::vector<double> samples_s;
  const auto start = Clock::now();
  while (samples_s.size() < kFewestSamples || since_s(start) < seconds)
    samples_s.push_back(mean_time_s(device, run, runs));
  return upper_median(std::move(samples_s));
}

}  // namespace mcdbn
