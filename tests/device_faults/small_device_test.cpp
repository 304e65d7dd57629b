// Devices that take less than this one: smaller plans, the same results.
#include <doctest/doctest.h>

#include "base/scoped_variable.hpp"
#include "base/scratch_folder.hpp"
#include "device/launch.hpp"
#include "device/row_tile.hpp"
#include "device/tuner.hpp"
#include "device_faults/tiny_training.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/device/matrix.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr layer::Limits kSmall{.group = 1, .local_bytes = 32768, .vector_width = 1};

}  // namespace

TEST_CASE("a small device is seen as it is, and plans are made for it") {
  const HealthyDriver driver;
  layer::limit(kSmall);
  Device device = Device::open();
  CHECK(device.info().largest_group == 1);
  CHECK(device.info().local_memory_bytes == 32768);
  CHECK(device.info().preferred_vector_width == 1);
  CHECK(device.info().native_vector_width == 1);
  CHECK(device.tuning().vector_width == 1);
  CHECK(device.tuning().group == 1);
  // Whatever a user's cache or a caller asks for.
  Tuning wide = device.tuning();
  wide.group = 64;
  wide.vector_width = 4;
  device.set_tuning(wide);
  CHECK(device.tuning().group == 1);
  CHECK(device.tuning().vector_width == 4);

  const auto plan = choose_row_tile(device, 2000, 100, "test");
  REQUIRE(plan);
  CHECK(plan->rows <= 4);  // 8000 bytes each
  CHECK(plan->group == 1);
  CHECK_FALSE(choose_row_tile(device, 8193, 100, "test"));
}

TEST_CASE("tiles of gradients are as many, and as long, as local memory holds") {
  const HealthyDriver driver;
  if (Device::open().info().is_gpu) return;  // whose panels are of one tile
  const auto plan = [](std::uint64_t local_bytes) {
    layer::limit({.local_bytes = local_bytes});
    return choose_row_tile(Device::open(), 16, 100, "test");
  };
  // A tile of 8 rows takes 2 · 128 · 8 floats.
  CHECK(plan(32768)->most_panel_tiles == 4);
  CHECK(plan(20000)->most_panel_tiles == 2);
  CHECK(plan(20000)->update_rows == 8);
  CHECK(plan(8000)->most_panel_tiles == 1);
  CHECK(plan(8000)->update_rows == 4);
  CHECK_FALSE(plan(4000));
  const auto panels = [&](std::uint64_t bytes) { return update_panels(*plan(bytes), 96); };
  CHECK(panels(32768) == 4);
  CHECK(panels(20000) == 6);
  CHECK(panels(8000) == 24);
}

TEST_CASE("a whole training on a device without groups and of little local memory: the same bits") {
  const HealthyDriver driver;
  const TinyTraining training;
  const auto want = training.train();
  layer::limit({.group = 1, .local_bytes = 6000});
  CHECK(training.train() == want);
}

TEST_CASE("a whole training on a small device: the same model but for the order of some sums") {
  const HealthyDriver driver;
  const TinyTraining training;
  const auto want = training.train();
  layer::limit(kSmall);
  const auto got = training.train();
  REQUIRE(got.size() == want.size());
  // Squares of a gradient are summed up vector by vector.
  constexpr float kSteps = 64;
  for (std::size_t i = 0; i < got.size(); ++i) {
    CAPTURE(i);
    const float difference = (got[i] - want[i]).cwiseAbs().maxCoeff();
    CHECK(difference <= kSteps * 0x1p-24F * want[i].cwiseAbs().maxCoeff());
  }
}

TEST_CASE("a device that does not take CLBlast's groups is tuned without CLBlast") {
  const HealthyDriver driver;
  layer::limit({.group = 32});
  Device device = Device::open();  // PoCL finds its own cache at the first call
  const ScratchFolder folder;
  const ScopedVariable cache("XDG_CACHE_HOME", (folder / "cache").string());
  const Tuning usual = device.tuning();
  const TunedTime time_s = [](const Tuning&) { return 1.0; };
  const auto notice = [](const std::string& text) {
    CHECK(text.find("CLBlast") == std::string::npos);  // it is not even tried
  };
  CHECK(tune(device, usual, {time_s, time_s}, 0.0, notice));
  const auto stored = load_tuning(device.info());
  REQUIRE(stored);
  CHECK(stored->clblast_from == 0);
}

TEST_CASE("CLBlast stays unused where the device refuses its work") {
  const HealthyDriver driver;
  Device device = Device::open();
  if (device.info().is_gpu) return;  // which might refuse our own groups, too
  layer::limit({.group = 32});
  std::vector<std::string> heard;
  const auto notice = [&](const std::string& text) { heard.push_back(text); };
  CHECK(clblast_threshold(device, 0.0, notice) == 0);
  REQUIRE(heard.size() == 1);
  CAPTURE(heard.front());
  CHECK(heard.front().find("CLBlast's product: the device takes no work-groups") !=
        std::string::npos);
  layer::fail("clEnqueueNDRangeKernel", 0, CL_DEVICE_NOT_AVAILABLE);
  CHECK_THROWS_AS(clblast_threshold(device, 0.0, notice), DeviceError);
}

TEST_CASE("the layer refuses what a small device would") {
  const HealthyDriver driver;
  Device device = Device::open();
  const Matrix out(device, 1, 16);
  cl::Program program(device.context(),
                      "kernel void touch(global float* out, local float* own) {\n"
                      "  own[0] = 1.0f;\n  out[0] = own[0];\n}\n");
  program.build();
  cl::Kernel kernel(program, "touch");
  const auto touch = [&](std::size_t group, std::size_t local_bytes) {
    launch(device, kernel, {{group, 1}, {group, 1}}, out.buffer(), cl::Local(local_bytes));
  };
  CHECK_NOTHROW(touch(2, 64));
  layer::limit({.group = 1});
  CHECK_NOTHROW(touch(1, 64));
  CHECK_THROWS_AS(touch(2, 64), DeviceError);
  layer::limit({.local_bytes = 32});
  CHECK_NOTHROW(touch(2, 16));
  CHECK_THROWS_AS(touch(2, 64), DeviceError);
}
