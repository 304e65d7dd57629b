#pragma once

#include <array>
#include <cstddef>

#include "device/program.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {

struct LaunchSize {
  std::array<std::size_t, 2> global{1, 1};
  /// Zeros: a GPU's driver chooses, on a CPU local_size_for.
  std::array<std::size_t, 2> local{0, 0};
};

/// Work-groups on a CPU, for work-items of a few instructions: up to 64 items, as far as the device
/// takes them, in powers of two that divide the range. Left to itself PoCL compiles a kernel anew
/// for every size of the range, each other length of clip, and may make one group, which one core
/// runs, of it all.
std::array<std::size_t, 2> local_size_for(const std::array<std::size_t, 2>& global,
                                          const DeviceInfo& info);

/// Keeps a host that only enqueues from running far ahead of its device: now and then, some ten
/// times a second, it waits for the queue. Otherwise a request to stop would go unnoticed for
/// minutes. A wait costs some 50 µs.
/// @throws Interrupted if that was asked for, DeviceError
void keep_pace(Device& device);

/// Enqueues a kernel whose arguments are set. The first launch with work-groups of a size is waited
/// for, and what it takes beyond the kernel's run counts as compiling (ProgramCache::compiling_s).
/// @throws cl::Error, DeviceError, Interrupted
void enqueue(Device& device, const cl::Kernel& kernel, const LaunchSize& size);

/// Error of a launch, with the kernel's name.
DeviceError launch_error(const Device& device, const cl::Kernel& kernel, const cl::Error& error);

/// Enqueues one kernel with its arguments set in order; returns at once, but for keep_pace() and a
/// first launch.
/// @throws DeviceError naming the kernel, Interrupted
template <typename... Arguments>
void launch(Device& device, cl::Kernel& kernel, const LaunchSize& size,
            const Arguments&... arguments) {
  try {
    cl_uint index = 0;
    (kernel.setArg(index++, arguments), ...);
    enqueue(device, kernel, size);
  } catch (const cl::Error& error) {
    throw launch_error(device, kernel, error);
  }
  keep_pace(device);
}

}  // namespace mcdbn
