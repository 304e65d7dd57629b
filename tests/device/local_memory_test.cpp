#include <doctest/doctest.h>

#include <cstdlib>
#include <numeric>

#include "device/every_device.hpp"
#include "device/launch.hpp"
#include "device/probe.hpp"

namespace local_memory_test {

using namespace mcdbn;
using namespace mcdbn::test;

// PoCL's trap (seen with 3.1): a helper that is not inlined and always gets the same `__local`
// array of the kernel's own may work on other memory, silently. Kernels of ours keep to the two
// forms that are safe: the helper is always_inline, or the array is a kernel argument.
namespace {

constexpr std::size_t kGroup = 16, kGroups = 4;

/// Each group sums its 16 numbers by a tree in local memory, through a helper.
const char* const kHelper = R"(
static float tree_sum(local float* values, int lane) {
  for (int half_size = 8; half_size > 0; half_size /= 2) {
    if (lane < half_size) values[lane] += values[lane + half_size];
    barrier(CLK_LOCAL_MEM_FENCE);
  }
  return values[0];
}
)";
const char* const kOwnArray = R"(
kernel void sums(global const float* in, global float* out) {
  local float values[16];
  const int lane = get_local_id(0);
  values[lane] = in[get_global_id(0)];
  barrier(CLK_LOCAL_MEM_FENCE);
  const float sum = tree_sum(values, lane);
  if (lane == 0) out[get_group_id(0)] = sum;
}
)";
const char* const kArgument = R"(
kernel void sums(global const float* in, global float* out, local float* values) {
  const int lane = get_local_id(0);
  values[lane] = in[get_global_id(0)];
  barrier(CLK_LOCAL_MEM_FENCE);
  const float sum = tree_sum(values, lane);
  if (lane == 0) out[get_group_id(0)] = sum;
}
)";

const std::string kInlined = std::string("__attribute__((always_inline)) ") + (kHelper + 1);
const std::string kNotInlined = std::string("__attribute__((noinline)) ") + (kHelper + 1);

std::vector<float> numbers() {
  std::vector<float> values(kGroup * kGroups);
  std::iota(values.begin(), values.end(), 1.0F);
  return values;
}

/// Whole numbers: every order of adding them is exact.
std::vector<float> wanted() {
  const auto in = numbers();
  std::vector<float> sums(kGroups, 0.0F);
  for (std::size_t i = 0; i < in.size(); ++i) sums[i / kGroup] += in[i];
  return sums;
}

template <typename... Arguments>
std::vector<float> sums(Device& device, const std::string& text, const Arguments&... arguments) {
  cl::Program program = build_probe(device, text, 1);
  cl::Kernel kernel(program, "sums");
  const cl::Buffer out = to_device(device, std::vector<float>(kGroups, -1.0F));
  launch(device, kernel, {{kGroup * kGroups, 1}, {kGroup, 1}}, to_device(device, numbers()), out,
         arguments...);
  return to_host<float>(device, out, kGroups);
}

/// The work on each device that takes such groups: with single work-items nothing is shared.
template <typename Work>
void on_every_device_with_groups(const Work& work) {
  on_every_device([&](Device& device) {
    if (device.info().largest_group >= kGroup) work(device);
  });
}

}  // namespace

TEST_CASE("small: an inlined helper works on the kernel's own local array") {
  on_every_device_with_groups(
      [](Device& device) { CHECK(sums(device, kInlined + kOwnArray) == wanted()); });
}

TEST_CASE("small: a helper works on a local array that is a kernel argument") {
  on_every_device_with_groups([](Device& device) {
    for (const auto& helper : {kInlined, kNotInlined})
      CHECK(sums(device, helper + kArgument, cl::Local(kGroup * sizeof(float))) == wanted());
  });
}

TEST_CASE(
    "the trap shows on PoCL 3.1 alone: helpers that are not inlined, the kernel's own array") {
  const bool optimized = std::getenv("MCDBN_BUILD_OPTIONS") == nullptr;
  on_every_device([&](Device& device) {
    const bool is_pocl = device.info().platform_name == "Portable Computing Language";
    const bool known = is_pocl && device.info().driver_version.starts_with("3.1");
    const bool right = sums(device, kNotInlined + kOwnArray) == wanted();
    // Where this fails the trap is gone, and with it what makes INLINE (units.clh) necessary.
    if (known && optimized) CHECK_FALSE(right);
    // No other driver was seen to fall into it; other versions of PoCL are not known.
    if (!is_pocl) CHECK(right);
  });
}

}  // namespace local_memory_test
