#include "device/kernel_rates.hpp"

#include <algorithm>
#include <map>

#include "base/upper_median.hpp"

namespace mcdbn {
namespace {

double seconds(std::uint64_t from_ns, std::uint64_t to_ns) {
  return to_ns > from_ns ? 1e-9 * static_cast<double>(to_ns - from_ns) : 0.0;
}

KernelWork work_of(const std::string& kernel, std::span<const KernelWork> all) {
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const KernelWork& work) { return work.kernel == kernel; });
  return found == all.end() ? KernelWork{kernel} : *found;
}

/// From the end of one launch to the start of the next.
double between_launches_s(const std::vector<LaunchTime>& times) {
  double sum_s = 0;
  for (std::size_t i = 1; i < times.size(); ++i)
    sum_s += seconds(times[i - 1].ended_ns, times[i].started_ns);
  return sum_s;
}

}  // namespace

StepTimes time_kernels(Device& device, const std::function<void()>& run,
                       std::span<const KernelWork> work, std::size_t runs) {
  device.keep_launch_times(true);
  StepTimes result;
  std::map<std::string, std::vector<double>> kernel_s;
  std::vector<double> between_s;
  for (std::size_t i = 0; i < runs; ++i) {
    run();
    result.last_times = device.take_launch_times();
    std::map<std::string, double> this_run_s;
    for (const LaunchTime& launch : result.last_times)
      this_run_s[launch.kernel] += seconds(launch.started_ns, launch.ended_ns);
    for (const auto& [kernel, spent_s] : this_run_s) kernel_s[kernel].push_back(spent_s);
    between_s.push_back(between_launches_s(result.last_times));
  }
  device.keep_launch_times(false);
  for (const LaunchTime& launch : result.last_times) {
    auto rate =
        std::find_if(result.kernels.begin(), result.kernels.end(),
                     [&](const KernelRate& known) { return known.work.kernel == launch.kernel; });
    if (rate == result.kernels.end())
      rate = result.kernels.insert(
          rate, {work_of(launch.kernel, work), 0, upper_median(kernel_s.at(launch.kernel))});
    ++rate->launches;
  }
  if (!between_s.empty()) result.between_s = upper_median(between_s);
  return result;
}

}  // namespace mcdbn
