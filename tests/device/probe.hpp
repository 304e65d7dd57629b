#pragma once

#include <cstdlib>
#include <string>
#include <vector>

#include "device/program.hpp"
#include "mcdbn/device/device.hpp"

namespace mcdbn::test {

/// Kernels of a test's own on top of the library's headers, for functions that no kernel of the
/// library shows alone.
inline cl::Program build_probe(Device& device, const std::string& text, int vector_width) {
  std::string options = "-cl-std=CL1.2 -DVEC=" + std::to_string(vector_width);
  if (const char* extra = std::getenv("MCDBN_BUILD_OPTIONS")) options += std::string(" ") + extra;
  cl::Program program(device.context(),
                      kernel_source("philox.clh") + kernel_source("units.clh") + text);
  program.build(options.c_str());
  return program;
}

template <typename T>
cl::Buffer to_device(Device& device, const std::vector<T>& values) {
  cl::Buffer buffer(device.context(), CL_MEM_READ_WRITE, values.size() * sizeof(T));
  device.queue().enqueueWriteBuffer(buffer, CL_TRUE, 0, values.size() * sizeof(T), values.data());
  return buffer;
}

template <typename T>
std::vector<T> to_host(Device& device, const cl::Buffer& buffer, std::size_t count) {
  std::vector<T> values(count);
  device.queue().enqueueReadBuffer(buffer, CL_TRUE, 0, count * sizeof(T), values.data());
  return values;
}

inline constexpr int kVectorWidths[] = {1, 2, 4, 8, 16};

}  // namespace mcdbn::test
