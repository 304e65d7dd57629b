#include "mcdbn/base/random.hpp"

#include <cmath>
#include <numbers>

#include "base/random_phases.hpp"
#include "random_phases.clh"

namespace mcdbn {
namespace {

using uint = std::uint32_t;

std::uint32_t multiply_high(std::uint32_t a, std::uint32_t b) {
  return static_cast<std::uint32_t>((static_cast<std::uint64_t>(a) * b) >> 32);
}

#include "philox.clh"

PHILOX_DEFINE(philox_rounds, std::uint32_t, multiply_high, )

static_assert(VISIBLE_PHASE == random_phases::kVisibleUnits);
static_assert(CHAIN_PHASES == random_phases::kPhasesOfChain);
static_assert(SECOND_UNIFORM == random_phases::kSecondUniform);

}  // namespace

std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                        std::array<std::uint32_t, 2> key) {
  philox_rounds(counter.data(), key[0], key[1]);
  return counter;
}

std::uint32_t random_bits(const RandomKey& key, std::uint32_t row, std::uint32_t column) {
  const std::array<std::uint32_t, 4> counter{
      column, row / 4, key.step, (static_cast<std::uint32_t>(key.stream) << 16) | key.phase};
  const std::array<std::uint32_t, 2> seed{static_cast<std::uint32_t>(key.seed),
                                          static_cast<std::uint32_t>(key.seed >> 32)};
  return philox4x32(counter, seed)[row % 4];
}

float random_uniform(const RandomKey& key, std::uint32_t row, std::uint32_t column) {
  return (static_cast<float>(random_bits(key, row, column) >> 9) + 0.5F) * 0x1p-23F;
}

double random_normal(const RandomKey& key, std::uint32_t row, std::uint32_t column) {
  RandomKey second = key;
  second.phase |= random_phases::kSecondUniform;
  const double first_uniform = random_uniform(key, row, column);
  const double second_uniform = random_uniform(second, row, column);
  return std::sqrt(-2.0 * std::log(first_uniform)) *
         std::cos(2.0 * std::numbers::pi * second_uniform);
}

}  // namespace mcdbn
