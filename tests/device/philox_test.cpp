#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "device/every_device.hpp"
#include "device/launch.hpp"
#include "device/probe.hpp"
#include "mcdbn/base/random.hpp"

namespace philox_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

struct KnownAnswer {
  std::array<std::uint32_t, 4> counter;
  std::array<std::uint32_t, 2> key;
  std::array<std::uint32_t, 4> words;
};

// Random123's kat_vectors for philox4x32 with 10 rounds.
const std::vector<KnownAnswer> kKnownAnswers = {
    {{0, 0, 0, 0}, {0, 0}, {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}},
    {{0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff},
     {0xffffffff, 0xffffffff},
     {0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}},
    {{0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344},
     {0xa4093822, 0x299f31d0},
     {0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}},
};

const char* const kPhiloxProbe = R"(
kernel void philox_probe(global const uint* counters, uint k0, uint k1, global uint* out) {
  uintN words[4];
  for (int i = 0; i < 4; ++i) words[i] = ((global const uintN*)counters)[i];
  philoxN(words, k0, k1);
  for (int i = 0; i < 4; ++i) ((global uintN*)out)[i] = words[i];
}
)";

cl_uint4 kernel_argument(const RandomKey& key) {
  return {{static_cast<cl_uint>(key.seed), static_cast<cl_uint>(key.seed >> 32), key.step,
           (static_cast<cl_uint>(key.stream) << 16) | key.phase}};
}

const RandomKey kPhiloxKey{
    .seed = 0x0123456789abcdef, .step = 0xfedcba98, .stream = 0xbeef, .phase = 0x7ffe};

/// The words of the library's own test kernel, with one more row as a guard.
void check_words(Device& device, int width, std::uint32_t rows, std::uint32_t columns) {
  CAPTURE(width);
  CAPTURE(rows);
  CAPTURE(columns);
  constexpr std::uint32_t kGuard = 0xdeadbeef;
  const std::vector<std::uint32_t> initial((rows + 1) * columns, kGuard);
  const cl::Buffer out = to_device(device, initial);
  launch(device, device.programs().kernel("pointwise.cl", "philox_words", {{"VEC", width}}),
         {{columns, rows}}, out, static_cast<cl_int>(columns), kernel_argument(kPhiloxKey));
  const auto words = to_host<std::uint32_t>(device, out, initial.size());
  int different = 0;
  for (std::uint32_t r = 0; r < rows; ++r)
    for (std::uint32_t c = 0; c < columns; ++c)
      different += words[r * columns + c] != random_bits(kPhiloxKey, r, c) ? 1 : 0;
  CHECK(different == 0);
  for (std::uint32_t c = 0; c < columns; ++c) CHECK(words[rows * columns + c] == kGuard);
}

/// Correlation of the uniform draws of two keys and places, over `n` columns.
double correlation(const RandomKey& x, std::uint32_t x_row, std::uint32_t x_shift,
                   const RandomKey& y, std::uint32_t y_row, std::uint32_t n) {
  double sum = 0;
  for (std::uint32_t c = 0; c < n; ++c)
    sum += (random_uniform(x, x_row, c + x_shift) - 0.5) * (random_uniform(y, y_row, c) - 0.5);
  return 12.0 * sum / n;
}

}  // namespace

TEST_CASE("small: Philox4x32-10 on the host gives Random123's known answers") {
  for (const auto& known : kKnownAnswers)
    CHECK(philox4x32(known.counter, known.key) == known.words);
}

TEST_CASE("small: Philox4x32-10 on the device gives Random123's known answers in every lane") {
  on_every_device([](Device& device) {
    for (const int width : kVectorWidths) {
      CAPTURE(width);
      cl::Program program = build_probe(device, kPhiloxProbe, width);
      cl::Kernel kernel(program, "philox_probe");
      const auto lanes = static_cast<std::size_t>(width);
      for (const auto& known : kKnownAnswers) {
        std::vector<std::uint32_t> counters;
        for (const auto word : known.counter) counters.insert(counters.end(), lanes, word);
        const cl::Buffer out = to_device(device, std::vector<std::uint32_t>(4 * lanes));
        launch(device, kernel, {}, to_device(device, counters), known.key[0], known.key[1], out);
        const auto words = to_host<std::uint32_t>(device, out, 4 * lanes);
        for (std::size_t i = 0; i < 4; ++i)
          for (std::size_t lane = 0; lane < lanes; ++lane)
            CHECK(words[i * lanes + lane] == known.words[i]);
      }
    }
  });
}

TEST_CASE("small: the device's random words are the host's, whatever the vector width") {
  on_every_device([](Device& device) {
    for (const int width : kVectorWidths)
      for (const auto& [rows, columns] : {std::pair{1U, 1U}, {3U, 3U}, {5U, 17U}, {13U, 7U}})
        check_words(device, width, rows, columns);
  });
}

TEST_CASE("the device's random words are the host's at the model's sizes") {
  on_every_device([](Device& device) {
    for (const int width : kVectorWidths) check_words(device, width, 100, 300);
  });
}

TEST_CASE("small: uniform numbers never reach 0 or 1") {
  const std::vector<std::uint32_t> extremes = {0,          1,          0x1ff,      0x200,
                                               0x7fffffff, 0x80000000, 0xfffffdff, 0xfffffe00,
                                               0xfffffffe, 0xffffffff, 0x55555555, 0xaaaaaaaa,
                                               0x12345678, 0x9abcdef0, 0x0000ffff, 0xffff0000};
  const char* const text = R"(
kernel void uniform_probe(global const uint* bits, global float* out) {
  const int at = get_global_id(0) * VEC;
  storeN(uniformN(*(global const uintN*)(bits + at)), at, out);
}
)";
  on_every_device([&](Device& device) {
    for (const int width : kVectorWidths) {
      cl::Program program = build_probe(device, text, width);
      cl::Kernel kernel(program, "uniform_probe");
      const cl::Buffer out = to_device(device, std::vector<float>(extremes.size()));
      launch(device, kernel, {{extremes.size() / static_cast<std::size_t>(width), 1}},
             to_device(device, extremes), out);
      const auto values = to_host<float>(device, out, extremes.size());
      for (std::size_t i = 0; i < extremes.size(); ++i) {
        CHECK(values[i] > 0.0F);
        CHECK(values[i] < 1.0F);
        CHECK(values[i] == (extremes[i] >> 9) * 0x1p-23 + 0x1p-24);  // exact in double
      }
    }
  });
}

TEST_CASE("small: random_uniform scales the host's bits like the device") {
  for (std::uint32_t row = 0; row < 9; ++row)
    for (std::uint32_t column = 0; column < 100; ++column)
      CHECK(random_uniform(kPhiloxKey, row, column) ==
            (random_bits(kPhiloxKey, row, column) >> 9) * 0x1p-23 + 0x1p-24);
}

TEST_CASE("uniform numbers fill (0, 1) evenly and do not depend on each other") {
  constexpr std::uint32_t kCount = 1U << 18;
  constexpr int kBins = 256;
  std::array<int, kBins> bins{};
  double sum = 0;
  for (std::uint32_t c = 0; c < kCount; ++c) {
    const double u = random_uniform(kPhiloxKey, 3, c);
    sum += u;
    ++bins[static_cast<std::size_t>(u * kBins)];
  }
  // Five standard deviations everywhere; the draws are fixed, so this does not flicker.
  CHECK(std::abs(sum / kCount - 0.5) < 5.0 / std::sqrt(12.0 * kCount));
  const double expected = static_cast<double>(kCount) / kBins;
  double chi_squared = 0;
  for (const int count : bins) chi_squared += (count - expected) * (count - expected) / expected;
  CHECK(std::abs(chi_squared - (kBins - 1)) < 5.0 * std::sqrt(2.0 * (kBins - 1)));

  RandomKey next_step = kPhiloxKey, next_phase = kPhiloxKey, next_stream = kPhiloxKey,
            next_seed = kPhiloxKey;
  ++next_step.step;
  --next_phase.phase;
  ++next_stream.stream;
  ++next_seed.seed;
  const double limit = 5.0 / std::sqrt(static_cast<double>(kCount));
  CHECK(std::abs(correlation(kPhiloxKey, 0, 1, kPhiloxKey, 0, kCount)) < limit);
  CHECK(std::abs(correlation(kPhiloxKey, 0, 0, kPhiloxKey, 1, kCount)) < limit);
  CHECK(std::abs(correlation(kPhiloxKey, 0, 0, kPhiloxKey, 4, kCount)) < limit);
  for (const RandomKey& other : {next_step, next_phase, next_stream, next_seed})
    CHECK(std::abs(correlation(kPhiloxKey, 0, 0, other, 0, kCount)) < limit);
}

TEST_CASE("normal numbers are Box-Muller's and have the moments of a normal distribution") {
  constexpr std::uint32_t kCount = 1U << 17;
  RandomKey second = kPhiloxKey;
  second.phase |= 0x8000U;
  double sum = 0, squares = 0, fourth = 0, worst = 0;
  for (std::uint32_t c = 0; c < kCount; ++c) {
    const double z = random_normal(kPhiloxKey, 1, c);
    const double u1 = random_uniform(kPhiloxKey, 1, c);
    const double u2 = random_uniform(second, 1, c);
    worst = std::max(worst, std::abs(z - std::sqrt(-2.0 * std::log(u1)) *
                                             std::cos(2.0 * std::numbers::pi * u2)));
    sum += z;
    squares += z * z;
    fourth += z * z * z * z;
  }
  CHECK(worst < 1e-12);
  CHECK(std::abs(sum / kCount) < 5.0 / std::sqrt(kCount));
  CHECK(std::abs(squares / kCount - 1.0) < 5.0 * std::sqrt(2.0 / kCount));
  CHECK(std::abs(fourth / kCount - 3.0) < 5.0 * std::sqrt(96.0 / kCount));
}

}  // namespace philox_test
