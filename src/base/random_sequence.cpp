#include "base/random_sequence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mcdbn {
namespace {

/// Steele, Lea and Flood's finaliser: neighbouring seeds give unrelated streams.
std::uint64_t split_mix(std::uint64_t z) {
  z += 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

}  // namespace

std::uint64_t mixed_seed(std::initializer_list<std::uint64_t> keys) {
  std::uint64_t state = 0;
  for (const std::uint64_t key : keys) state = split_mix(state ^ key);
  return state;
}

std::uint32_t RandomSequence::bits() {
  if (drawn_ == 0xffffffffU) ++key_.step;
  return random_bits(key_, drawn_++, 0);
}

double RandomSequence::uniform() {
  const std::uint64_t high = bits() >> 5, low = bits() >> 6;
  return static_cast<double>((high << 26) | low) * 0x1p-53;
}

double RandomSequence::normal() {
  // Box-Muller; 1 − u is never 0
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  return radius * std::cos(2.0 * std::numbers::pi * uniform());
}

std::size_t RandomSequence::below(std::size_t count) {
  return std::min(count - 1, static_cast<std::size_t>(uniform() * static_cast<double>(count)));
}

}  // namespace mcdbn
