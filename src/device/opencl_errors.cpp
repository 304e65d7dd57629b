#include "device/opencl_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace mcdbn {
namespace {

struct Meaning {
  const char* text = nullptr;
  DeviceError::Kind kind = DeviceError::Kind::refused;
};

constexpr Meaning kLost{
    "the device is lost: it was reset or taken away, or its driver gave up; the system's log may "
    "give the reason",
    DeviceError::Kind::no_device};
constexpr Meaning kNoMemory{
    "out of memory; smaller layers, mini-batches or fewer clips need less, and so does a device "
    "that nothing else uses"};
// Its driver may also have reset it: then other work fails, too, and reports it again.
constexpr Meaning kNoResources{
    "the device is out of memory or registers, or its driver reset it; smaller layers and "
    "mini-batches need less"};
constexpr Meaning kGroupTooLarge{"the device takes no work-groups of this size"};

struct Failure {
  cl_int code;
  const char* name;
  Meaning meaning{};
};

/// OpenCL's errors; those of a driver's state, not of a mistake in this library, have a meaning.
constexpr std::array kFailures{
    Failure{CL_DEVICE_NOT_FOUND, "CL_DEVICE_NOT_FOUND", kLost},
    Failure{CL_DEVICE_NOT_AVAILABLE, "CL_DEVICE_NOT_AVAILABLE", kLost},
    Failure{CL_COMPILER_NOT_AVAILABLE,
            "CL_COMPILER_NOT_AVAILABLE",
            {"the driver has no compiler for kernels", DeviceError::Kind::no_device}},
    Failure{CL_MEM_OBJECT_ALLOCATION_FAILURE, "CL_MEM_OBJECT_ALLOCATION_FAILURE", kNoMemory},
    Failure{CL_OUT_OF_RESOURCES, "CL_OUT_OF_RESOURCES", kNoResources},
    Failure{CL_OUT_OF_HOST_MEMORY, "CL_OUT_OF_HOST_MEMORY", kNoMemory},
    Failure{CL_BUILD_PROGRAM_FAILURE, "CL_BUILD_PROGRAM_FAILURE", {"kernels could not be built"}},
    Failure{CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST,
            "CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST", kLost},
    Failure{CL_INVALID_DEVICE, "CL_INVALID_DEVICE", kLost},
    Failure{CL_INVALID_CONTEXT, "CL_INVALID_CONTEXT", kLost},
    Failure{CL_INVALID_COMMAND_QUEUE, "CL_INVALID_COMMAND_QUEUE", kLost},
    Failure{CL_INVALID_WORK_GROUP_SIZE, "CL_INVALID_WORK_GROUP_SIZE", kGroupTooLarge},
    Failure{CL_INVALID_WORK_ITEM_SIZE, "CL_INVALID_WORK_ITEM_SIZE", kGroupTooLarge},
    Failure{CL_INVALID_BUFFER_SIZE, "CL_INVALID_BUFFER_SIZE", kNoMemory},
    Failure{CL_PROFILING_INFO_NOT_AVAILABLE,
            "CL_PROFILING_INFO_NOT_AVAILABLE",
            {"the device keeps no times"}},
    Failure{-9999,
            "NVIDIA's -9999",
            {"a kernel read or wrote where it must not; please report it",
             DeviceError::Kind::no_device}},
    Failure{CL_INVALID_VALUE, "CL_INVALID_VALUE"},
    Failure{CL_INVALID_BINARY, "CL_INVALID_BINARY"},
    Failure{CL_INVALID_BUILD_OPTIONS, "CL_INVALID_BUILD_OPTIONS"},
    Failure{CL_INVALID_PROGRAM_EXECUTABLE, "CL_INVALID_PROGRAM_EXECUTABLE"},
    Failure{CL_INVALID_KERNEL_NAME, "CL_INVALID_KERNEL_NAME", {"there is no kernel of that name"}},
    Failure{CL_INVALID_KERNEL_ARGS, "CL_INVALID_KERNEL_ARGS"},
    Failure{CL_INVALID_ARG_SIZE, "CL_INVALID_ARG_SIZE"},
    Failure{CL_INVALID_MEM_OBJECT, "CL_INVALID_MEM_OBJECT"},
    Failure{CL_MISALIGNED_SUB_BUFFER_OFFSET, "CL_MISALIGNED_SUB_BUFFER_OFFSET"},
    Failure{CL_INVALID_OPERATION, "CL_INVALID_OPERATION"},
};

const Failure* known_failure(cl_int code) {
  const auto found = std::ranges::find(kFailures, code, &Failure::code);
  return found == kFailures.end() ? nullptr : &*found;
}

}  // namespace

std::string opencl_failure(cl_int code) {
  const Failure* failure = known_failure(code);
  if (!failure) return fmt::format("OpenCL's error {}", code);
  return failure->meaning.text ? fmt::format("{} ({})", failure->meaning.text, failure->name)
                               : std::string(failure->name);
}

DeviceError::Kind kind_of_failure(cl_int code) {
  const Failure* failure = known_failure(code);
  return failure ? failure->meaning.kind : DeviceError::Kind::refused;
}

DeviceError device_error(const std::string& device, const std::string& what,
                         const cl::Error& error) {
  return DeviceError(fmt::format("{}: {}: {}, reported by {}", device, what,
                                 opencl_failure(error.err()), error.what()),
                     kind_of_failure(error.err()));
}

}  // namespace mcdbn
