#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>

#include "mcdbn/base/random.hpp"

namespace mcdbn {

/// One seed of several numbers (seed, subject, clip …): neighbours give unrelated ones.
std::uint64_t mixed_seed(std::initializer_list<std::uint64_t> keys);

/// Draws one after another, for host code that does not number its draws: the same Philox as
/// everywhere, and transforms of our own, as the standard's distributions differ between libraries.
class RandomSequence {
 public:
  explicit RandomSequence(std::uint64_t seed, std::uint16_t stream = 0)
      : key_{seed, 0, stream, 0} {}

  /// In [0, 1), of 53 bits.
  double uniform();
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  bool chance(double probability) { return uniform() < probability; }
  double normal();
  /// One of 0 … count − 1. @param count at least 1
  std::size_t below(std::size_t count);

 private:
  std::uint32_t bits();

  RandomKey key_;
  std::uint32_t drawn_ = 0;
};

}  // namespace mcdbn
