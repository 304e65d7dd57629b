#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "device/every_device.hpp"
#include "device/launch.hpp"
#include "device/probe.hpp"
#include "reference/units_reference.hpp"

namespace activation_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

const char* const kProbes = R"(
kernel void exp_probe(global const float* x, global float* out) {
  const int at = get_global_id(0) * VEC;
  storeN(expN(loadN(at, x)), at, out);
}
kernel void sigmoid_probe(global const float* x, global float* out) {
  const int at = get_global_id(0) * VEC;
  storeN(sigmoidN(loadN(at, x)), at, out);
}
)";

/// @param x a multiple of 16 numbers
std::vector<float> evaluate(Device& device, const char* probe, int width,
                            const std::vector<float>& x) {
  cl::Program program = build_probe(device, kProbes, width);
  cl::Kernel kernel(program, probe);
  const cl::Buffer out = to_device(device, std::vector<float>(x.size()));
  launch(device, kernel, {{x.size() / static_cast<std::size_t>(width), 1}}, to_device(device, x),
         out);
  return to_host<float>(device, out, x.size());
}

/// |got − want| in units of the last place of `want` as a float.
double ulp_error(float got, double want) {
  const int exponent = std::max(std::ilogb(want), std::numeric_limits<float>::min_exponent - 1);
  return std::abs(got - want) / std::ldexp(1.0, exponent - 23);
}

std::vector<float> evenly_spaced(float low, float high, std::size_t count) {
  std::vector<float> x(count);
  for (std::size_t i = 0; i < count; ++i)
    x[i] = low + (high - low) * (static_cast<float>(i) / static_cast<float>(count - 1));
  return x;
}

/// Evenly spaced numbers, and both signs of every magnitude down to 1e-30.
std::vector<float> arguments(float low, float high, std::size_t count) {
  std::vector<float> x = evenly_spaced(low, high, count);
  for (int i = 0; i < 64; ++i) {
    const float small = std::pow(10.0F, -30.0F + 0.46F * static_cast<float>(i));
    x[2 * static_cast<std::size_t>(i)] = small;
    x[2 * static_cast<std::size_t>(i) + 1] = -small;
  }
  return x;
}

double worst_exp(Device& device, int width, std::size_t count) {
  const auto x = arguments(-87.0F, 88.0F, count);
  const auto y = evaluate(device, "exp_probe", width, x);
  double worst = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double error = ulp_error(y[i], std::exp(static_cast<double>(x[i])));
    if (!(error <= worst)) worst = error;
  }
  return worst;
}

double worst_sigmoid(Device& device, int width, std::size_t count) {
  // Down to where the result would be subnormal.
  const auto x = arguments(-87.0F, 100.0F, count);
  const auto y = evaluate(device, "sigmoid_probe", width, x);
  double worst = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double error = ulp_error(y[i], reference::sigmoid(static_cast<double>(x[i])));
    if (!(error <= worst)) worst = error;
  }
  return worst;
}

}  // namespace

TEST_CASE("small: exp stays under 1 ulp and the sigmoid under 5") {
  on_every_device([](Device& device) {
    for (const int width : kVectorWidths) {
      CAPTURE(width);
      CHECK(worst_exp(device, width, 4096) < 1.0);
      CHECK(worst_sigmoid(device, width, 4096) < 5.0);
    }
  });
}

TEST_CASE("exp stays under 1 ulp and the sigmoid under 5 over their whole range") {
  on_every_device([](Device& device) {
    const double exp_ulp = worst_exp(device, 16, 1U << 21);
    const double sigmoid_ulp = worst_sigmoid(device, 16, 1U << 21);
    MESSAGE(device.info().name, ": exp ", exp_ulp, " ulp, sigmoid ", sigmoid_ulp, " ulp");
    CHECK(exp_ulp < 1.0);
    CHECK(sigmoid_ulp < 5.0);
  });
}

TEST_CASE("small: the sigmoid saturates to 0 and 1 and never leaves them") {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  std::vector<float> x = {-100.0F, 100.0F, -kInfinity, kInfinity, -3e38F, 3e38F, 0.0F, -0.0F};
  x.resize(16, 0.0F);
  on_every_device([&](Device& device) {
    for (const int width : kVectorWidths) {
      CAPTURE(width);
      const auto y = evaluate(device, "sigmoid_probe", width, x);
      for (const std::size_t low : {0U, 2U, 4U}) {
        CHECK(y[low] >= 0.0F);
        CHECK(y[low] <= std::numeric_limits<float>::min());
      }
      for (const std::size_t high : {1U, 3U, 5U}) CHECK(y[high] == 1.0F);
      CHECK(y[6] == 0.5F);
      CHECK(y[7] == 0.5F);
    }
  });
}

TEST_CASE("small: NaN stays NaN in exp and sigmoid, so that the divergence guard sees it") {
  const std::vector<float> x(16, std::numeric_limits<float>::quiet_NaN());
  on_every_device([&](Device& device) {
    for (const int width : kVectorWidths)
      for (const char* probe : {"exp_probe", "sigmoid_probe"}) {
        CAPTURE(width);
        CAPTURE(probe);
        const auto y = evaluate(device, probe, width, x);
        CHECK(std::all_of(y.begin(), y.end(), [](float value) { return std::isnan(value); }));
      }
  });
}

}  // namespace activation_test
