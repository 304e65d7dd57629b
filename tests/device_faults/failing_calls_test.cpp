// Whatever call of OpenCL's fails, and whenever: a DeviceError in words, and nothing kept.
#include <memory>

#include "device/opencl_errors.hpp"
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

TEST_CASE("a code is given in words with its name, an unknown one by its number") {
  CHECK(contains(opencl_failure(CL_DEVICE_NOT_AVAILABLE), "lost"));
  CHECK(contains(opencl_failure(CL_DEVICE_NOT_AVAILABLE), "(CL_DEVICE_NOT_AVAILABLE)"));
  CHECK(contains(opencl_failure(CL_OUT_OF_HOST_MEMORY), "out of memory"));
  CHECK(contains(opencl_failure(CL_INVALID_WORK_GROUP_SIZE), "work-groups"));
  CHECK(opencl_failure(CL_INVALID_VALUE) == "CL_INVALID_VALUE");
  CHECK(opencl_failure(-4711) == "OpenCL's error -4711");
}
