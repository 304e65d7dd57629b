#include "device/peak.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <limits>
#include <vector>

#include "base/upper_median.hpp"
#include "device/kernel_arguments.hpp"

namespace mcdbn {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_of(Device& device, const std::function<void()>& run) {
  device.finish();
  const auto start = Clock::now();
  run();
  device.finish();
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The shortest of the medians of several rounds: a round in which a core was late or busy with
/// something else does not count, nor does a single lucky run.
double best_median_s(Device& device, const std::function<void()>& run) {
  constexpr std::size_t kRounds = 5, kRuns = 5;
  run();
  double best_s = std::numeric_limits<double>::infinity();
  for (std::size_t round = 0; round < kRounds; ++round) {
    std::vector<double> runs_s(kRuns);
    for (double& run_s : runs_s) run_s = seconds_of(device, run);
    best_s = std::min(best_s, upper_median(std::move(runs_s)));
  }
  return best_s;
}

/// Work-items in groups of the device's usual size, so many groups for each compute unit.
struct Range {
  std::size_t group, items;
  Range(const Device& device, std::size_t groups)
      : group(static_cast<std::size_t>(default_tuning(device.info()).group)),
        items(std::max(1U, device.info().compute_units) * group * groups) {}
};

}  // namespace

double measure_peak_gflops(Device& device) {
  constexpr int kChains = 16, kIterations = 20000;
  const int vec = vector_width(device);
  const Range range(device, 64);
  cl::Kernel& kernel =
      device.programs().kernel("peak.cl", "fma_loop", {{"VEC", vec}, {"CHAINS", kChains}});
  const Matrix out(device, 1, range.items);
  const double seconds = best_median_s(device, [&] {
    launch(device, kernel, {{range.items, 1}, {range.group, 1}}, out.buffer(), kIterations, 0.999F,
           0.001F);
  });
  return 2e-9 * vec * kChains * kIterations * static_cast<double>(range.items) / seconds;
}

double measure_read_gbytes_per_s(Device& device, std::size_t bytes) {
  constexpr double kLeastBytes = 256e6;  // of a run: some milliseconds
  const int vec = vector_width(device);
  const Range range(device, 16);
  const auto row = std::size_t{8} * static_cast<std::size_t>(vec);  // what a step of the loop reads
  const std::size_t rows = std::max<std::size_t>(1, bytes / sizeof(float) / range.items / row);
  const double pass_bytes = static_cast<double>(rows * row * range.items * sizeof(float));
  const int passes = std::max(1, static_cast<int>(kLeastBytes / pass_bytes));
  cl::Kernel& kernel = device.programs().kernel("peak.cl", "read_loop", {{"VEC", vec}});
  const Matrix in(device, range.items, rows * row), out(device, 1, range.items);
  const double seconds = best_median_s(device, [&] {
    launch(device, kernel, {{range.items, 1}, {range.group, 1}}, in.buffer(), to_int(rows), passes,
           out.buffer());
  });
  return 1e-9 * pass_bytes * passes / seconds;
}

}  // namespace mcdbn
