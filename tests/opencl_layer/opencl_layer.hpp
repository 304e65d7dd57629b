#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

/// A layer of OpenCL's loader (OPENCL_LAYERS) between a program and its driver, for tests only: it
/// counts objects, lets calls fail, and makes the devices smaller than they are.
namespace mcdbn::test::layer {

/// From now on the call of that name, such as "clFinish", fails with the code (of cl.h) once it was
/// made so many times.
/// @param loses_device every call that creates or enqueues something fails from then on, too
void fail(const std::string& call, std::size_t after, int code, bool loses_device = false);
/// The same for that one call alone.
void fail_once(const std::string& call, std::size_t after, int code);
/// What clGetProgramBuildInfo gives as the log; empty: the driver's own.
void set_build_log(const std::string& text);
/// No call fails any longer; calls are counted from 0 again.
void heal();

/// How often each call was made since heal(), those that failed included.
std::map<std::string, std::size_t> calls();
/// Objects of each kind that are still referred to: "context", "queue", "buffer", "program",
/// "kernel", "event". Kinds without any are left out.
std::map<std::string, long> objects();
/// Of the largest buffer that was asked for since heal().
std::size_t largest_buffer_bytes();

/// The limits that every device reports and keeps to.
struct Limits {
  std::size_t group = SIZE_MAX;            ///< work-items
  std::uint64_t local_bytes = UINT64_MAX;  ///< of a group
  unsigned vector_width = UINT32_MAX;      ///< floats, preferred and native
  std::uint64_t buffer_bytes = UINT64_MAX;
};
void limit(const Limits& limits);

}  // namespace mcdbn::test::layer
