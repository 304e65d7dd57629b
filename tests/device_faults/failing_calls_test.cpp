// Whatever call of OpenCL's fails, and whenever: a DeviceError in words, and nothing kept.
#include <memory>
#include <optional>

#include "device/opencl_errors.hpp"
#include "device/program.hpp"
#include "device_faults/tiny_training.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/device/matrix.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

template <typename Work>
std::string error_of(const Work& work) {
  try {
    work();
  } catch (const DeviceError& error) {
    return error.what();
  }
  return "";
}

/// What it leaves of the device.
template <typename Work>
std::optional<DeviceError::Kind> kind_of(const Work& work) {
  try {
    work();
  } catch (const DeviceError& error) {
    return error.kind();
  }
  return {};
}

bool contains(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

}  // namespace

TEST_CASE(
    "any call that fails in a training, the first, the last and one between, is a DeviceError") {
  const HealthyDriver driver;
  const TinyTraining training;
  layer::heal();
  auto device = std::make_unique<Device>(Device::open());
  const auto want = training.train(*device);
  const auto first_calls = layer::calls();
  layer::heal();
  training.train(*device);
  const auto later_calls = layer::calls();
  const auto open = layer::objects();
  REQUIRE(first_calls.size() > 15);  // else the layer is not between

  const auto check_failures = [&](const std::string& name, std::size_t count, auto&& train,
                                  const auto& objects) {
    // How often is waited for the device depends on the time that passes.
    const std::size_t last = name == "clFinish" ? count / 4 : count - 1;
    for (const std::size_t after : {std::size_t{0}, count / 2, last}) {
      CAPTURE(name);
      CAPTURE(after);
      layer::heal();
      layer::fail(name, after, CL_OUT_OF_RESOURCES);
      CHECK_THROWS_AS(train(), DeviceError);
      CHECK(layer::objects() == objects);
    }
    layer::heal();
  };
  const auto is_of_references = [](const std::string& name) {
    return name.starts_with("clRetain") || name.starts_with("clRelease");
  };
  // Of a training whose kernels are built,
  for (const auto& [name, count] : later_calls)
    if (!is_of_references(name))
      check_failures(
          name, count, [&] { training.train(*device); }, open);
  CHECK(training.train(*device) == want);  // the device is as it was
  device.reset();
  CHECK(layer::objects().empty());
  // and those that open a device and build.
  for (const auto& [name, count] : first_calls)
    if (!is_of_references(name) && !later_calls.contains(name))
      check_failures(
          name, count, [&] { training.train(); }, std::map<std::string, long>());
  CHECK(training.train() == want);
}

TEST_CASE(
    "a device that is lost in the middle, once and for all, is a DeviceError that reports it") {
  const HealthyDriver driver;
  const TinyTraining training;
  const std::string name = Device::open().info().name;
  const auto before = layer::objects();
  for (const int code : {CL_DEVICE_NOT_AVAILABLE, CL_INVALID_COMMAND_QUEUE, CL_OUT_OF_RESOURCES}) {
    layer::heal();
    layer::fail("clEnqueueNDRangeKernel", 40, code, true);
    layer::fail("clGetKernelInfo", 0, code);  // nor is the kernel's name given
    const std::string error = error_of([&] { training.train(); });
    CAPTURE(error);
    CHECK(contains(error,
                   code == CL_OUT_OF_RESOURCES ? "its driver reset it" : "the device is lost"));
    CHECK(error.starts_with(name + ": a kernel: "));
    CHECK(layer::objects() == before);
  }
}

TEST_CASE("out of device memory: how much was wanted, or what needs less") {
  const HealthyDriver driver;
  Device device = Device::open();
  layer::fail("clCreateBuffer", 0, CL_MEM_OBJECT_ALLOCATION_FAILURE);
  const std::string refused = error_of([&] { Matrix(device, 1000, 1000); });
  CAPTURE(refused);
  CHECK(contains(refused, device.info().name + ": no room for 4.03 MB more, of "));
  CHECK(contains(refused, "smaller layers and mini-batches"));
  // Many drivers give memory only when it is first used.
  layer::heal();
  layer::fail("clEnqueueFillBuffer", 0, CL_MEM_OBJECT_ALLOCATION_FAILURE);
  const std::string late = error_of([&] { Matrix(device, 1000, 1000); });
  CAPTURE(late);
  CHECK(contains(late, device.info().name + ": clearing a matrix: out of memory"));
  CHECK(contains(late, "CL_MEM_OBJECT_ALLOCATION_FAILURE"));
}

TEST_CASE("a buffer larger than the device takes: the largest is named, not its whole memory") {
  const HealthyDriver driver;
  layer::limit({.buffer_bytes = 1'000'000});
  Device device = Device::open();
  CHECK(device.info().largest_buffer_bytes == 1'000'000);
  CHECK_NOTHROW(Matrix(device, 10, 16'000));
  const std::string refused = error_of([&] { Matrix(device, 1000, 1000); });
  CAPTURE(refused);
  CHECK(contains(refused, device.info().name +
                              ": no room for 4.03 MB in one buffer, it takes 1 MB at most, of "));
  CHECK(contains(refused, "smaller layers and mini-batches"));
}

TEST_CASE("an error tells work that was refused from a device that is lost") {
  const HealthyDriver driver;
  using enum DeviceError::Kind;
  Device device = Device::open();
  const auto kind_after = [&](const char* call, int code, const auto& work) {
    layer::heal();
    layer::fail(call, 0, code);
    return kind_of(work);
  };
  const auto make = [&] { Matrix(device, 1000, 1000); };
  const auto build = [] {
    Device::open().programs().kernel("pointwise.cl", "transpose", {{"VEC", 4}});
  };
  // When it is asked for, and when it is first used.
  for (const char* call : {"clCreateBuffer", "clEnqueueFillBuffer"}) {
    CHECK(kind_after(call, CL_MEM_OBJECT_ALLOCATION_FAILURE, make) == refused);
    CHECK(kind_after(call, CL_OUT_OF_RESOURCES, make) == refused);
    CHECK(kind_after(call, CL_DEVICE_NOT_AVAILABLE, make) == no_device);
  }
  CHECK(kind_after("clBuildProgram", CL_BUILD_PROGRAM_FAILURE, build) == refused);
  CHECK(kind_after("clBuildProgram", CL_DEVICE_NOT_AVAILABLE, build) == no_device);
  CHECK(kind_of([&] { Matrix(device, 1U << 20U, 1U << 12U); }) == refused);
  CHECK(kind_of([] { Device::open({"", "no such device"}); }) == no_device);
  CHECK(kind_of_failure(CL_INVALID_COMMAND_QUEUE) == no_device);
  CHECK(kind_of_failure(CL_INVALID_WORK_GROUP_SIZE) == refused);
  CHECK(kind_of_failure(-4711) == refused);
}

TEST_CASE("a code is given in words with its name, an unknown one by its number") {
  CHECK(contains(opencl_failure(CL_DEVICE_NOT_AVAILABLE), "lost"));
  CHECK(contains(opencl_failure(CL_DEVICE_NOT_AVAILABLE), "(CL_DEVICE_NOT_AVAILABLE)"));
  CHECK(contains(opencl_failure(CL_OUT_OF_HOST_MEMORY), "out of memory"));
  CHECK(contains(opencl_failure(CL_INVALID_WORK_GROUP_SIZE), "work-groups"));
  CHECK(opencl_failure(CL_INVALID_VALUE) == "CL_INVALID_VALUE");
  CHECK(opencl_failure(-4711) == "OpenCL's error -4711");
}
