#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "mcdbn/device/device.hpp"

namespace mcdbn {

/// What one kernel has to do at least in one run of a step, all its launches together.
struct KernelWork {
  std::string kernel;
  double flops = 0;  ///< useful arithmetic, 2 a multiply-add
  double bytes = 0;  ///< of every matrix that it reads or writes, once each
};

/// How a kernel did.
struct KernelRate {
  KernelWork work;           ///< zeros where it was not counted
  std::size_t launches = 0;  ///< of one run
  double seconds = 0;        ///< of one run, all its launches together
};

/// A step by its kernels, in the order of their first launches.
struct StepTimes {
  std::vector<KernelRate> kernels;
  double between_s = 0;                ///< of one run, in which no kernel ran
  std::vector<LaunchTime> last_times;  ///< of the last run's launches
};

/// Runs the step `runs` times with the times of its launches kept. A kernel's time is the median
/// over the runs. The device's queue keeps no times afterwards.
StepTimes time_kernels(Device& device, const std::function<void()>& run,
                       std::span<const KernelWork> work, std::size_t runs);

}  // namespace mcdbn
