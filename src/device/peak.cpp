#include "device/peak.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <vector>

#include "base/upper_median.hpp"
#include "device/kernel_arguments.hpp"

namespace mcdbn {
namespace {

/// The shortest median of a few launches in a row, of many that follow each other: threads that the
/// system first put on one core have moved apart by then, as they do not sleep in between; and
/// neither a disturbed launch counts nor a single lucky one.
double best_median_s(Device& device, const std::function<void()>& run) {
  constexpr std::size_t kRuns = 40, kInARow = 5;
  run();  // builds the program
  const bool keeps = device.keeps_launch_times();
  device.keep_launch_times(true);
  for (std::size_t i = 0; i < kRuns; ++i) run();
  const std::vector<LaunchTime> times = device.take_launch_times();
  device.keep_launch_times(keeps);
  std::vector<double> runs_s;
  runs_s.reserve(times.size());
  for (const LaunchTime& time : times)
    runs_s.push_back(1e-9 * static_cast<double>(time.ended_ns - time.started_ns));
  double best_s = std::numeric_limits<double>::infinity();
  for (auto first = runs_s.begin(); runs_s.end() - first >= std::ptrdiff_t{kInARow}; ++first)
    best_s = std::min(best_s, upper_median({first, first + kInARow}));
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
  return measure_peak_gflops(device, vector_width(device));
}

double measure_peak_gflops(Device& device, int vec) {
  constexpr int kChains = 16, kIterations = 20000;
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

bool has_units_of_16_floats(Device& device) {
  constexpr double kBetween = 1.5;  // 1 where a unit takes two passes, 2 where it takes one
  return measure_peak_gflops(device, 16) > kBetween * measure_peak_gflops(device, 8);
}

double measure_read_gbytes_per_s(Device& device, std::size_t bytes) {
  constexpr double kLeastBytes = 256e6;  // of a run: some milliseconds
  const int vec = vector_width(device);
  const Range range(device, 16);
  const auto row = std::size_t{8} * static_cast<std::size_t>(vec);  // what a step of the loop reads
  const std::size_t rows = std::max<std::size_t>(1, bytes / sizeof(float) / range.items / row);
  const auto pass_bytes = static_cast<double>(rows * row * range.items * sizeof(float));
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
