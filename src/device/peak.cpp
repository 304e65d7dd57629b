#include "device/peak.hpp"

#include <algorithm>
#include <chrono>

#include "device/kernel_arguments.hpp"

namespace mcdbn {

double measure_peak_gflops(Device& device) {
  constexpr int kChains = 16, kIterations = 20000, kRuns = 15;
  const int vec = vector_width(device);
  const std::size_t group = static_cast<std::size_t>(default_tuning(device.info()).group);
  const std::size_t items = device.info().compute_units * group * 16;
  cl::Kernel& kernel =
      device.programs().kernel("peak.cl", "fma_loop", {{"VEC", vec}, {"CHAINS", kChains}});
  const Matrix out(device, 1, items);
  const double flops = 2.0 * vec * kChains * kIterations * static_cast<double>(items);
  double best = 0;
  for (int run = 0; run < kRuns; ++run) {
    device.finish();
    const auto start = std::chrono::steady_clock::now();
    launch(device, kernel, {{items, 1}, {group, 1}}, out.buffer(), kIterations, 0.999F, 0.001F);
    device.finish();
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    best = std::max(best, flops / elapsed.count() * 1e-9);
  }
  return best;
}

}  // namespace mcdbn
