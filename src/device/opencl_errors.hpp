#pragma once

#include <string>
#include <utility>

#include "mcdbn/base/errors.hpp"
#include "mcdbn/device/opencl.hpp"

namespace mcdbn {

/// What a code of OpenCL's means to who runs the program, with its name: "the device is lost …
/// (CL_DEVICE_NOT_AVAILABLE)".
std::string opencl_failure(cl_int code);
/// A code that is not known is one of the work that was refused.
DeviceError::Kind kind_of_failure(cl_int code);

/// @param what "kernel gibbs_chain", "opening the device"
DeviceError device_error(const std::string& device, const std::string& what,
                         const cl::Error& error);

/// Makes an OpenCL call; every call of the library's goes through here.
/// @throws DeviceError as device_error makes it
template <typename Call>
auto checked(const std::string& device, const char* what, Call&& call) {
  try {
    return std::forward<Call>(call)();
  } catch (const cl::Error& error) {
    throw device_error(device, what, error);
  }
}

}  // namespace mcdbn
