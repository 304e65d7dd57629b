#pragma once

#include <array>
#include <cstddef>

#include "mcdbn/device/program.hpp"
#include "mcdbn/errors.hpp"

namespace mcdbn {

struct LaunchSize {
  std::array<std::size_t, 2> global{1, 1};
  std::array<std::size_t, 2> local{0, 0};  ///< zeros: the driver chooses
};

/// Enqueues one kernel with its arguments set in order; returns at once.
/// @throws DeviceError naming the kernel
template <typename... Arguments>
void launch(Device& device, cl::Kernel& kernel, const LaunchSize& size,
            const Arguments&... arguments) {
  try {
    cl_uint index = 0;
    (kernel.setArg(index++, arguments), ...);
    const cl::NDRange local =
        size.local[0] == 0 ? cl::NullRange : cl::NDRange(size.local[0], size.local[1]);
    device.queue().enqueueNDRangeKernel(kernel, cl::NullRange,
                                        cl::NDRange(size.global[0], size.global[1]), local);
    device.count_launch();
  } catch (const cl::Error& error) {
    throw DeviceError("kernel " + kernel.getInfo<CL_KERNEL_FUNCTION_NAME>() + " on " +
                      device.info().name + ": " + error.what() + " returned " +
                      std::to_string(error.err()));
  }
}

}  // namespace mcdbn
