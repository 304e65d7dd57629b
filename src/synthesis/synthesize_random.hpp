#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>

#include "base/random_sequence.hpp"

namespace mcdbn::synthesis {

/// What synthesis draws from.
class Random : public RandomSequence {
 public:
  /// Independent streams for different keys (seed, subject, clip, …).
  explicit Random(std::initializer_list<std::uint64_t> keys) : RandomSequence(mixed_seed(keys)) {}

  /// Normal, redrawn beyond 2 deviations, so that bodies stay plausible.
  double normal(double mean, double deviation);
};

/// Smooth drift around 0: a sum of sinusoids of unrelated frequencies.
class SlowNoise {
 public:
  SlowNoise() = default;
  /// @param deviation its root mean square  @param frequency_hz where its power is centred
  SlowNoise(Random& random, double deviation, double frequency_hz);

  double operator()(double t_s) const;

 private:
  struct Wave {
    double amplitude = 0, radians_per_s = 0, phase = 0;
  };
  std::array<Wave, 4> waves_{};
};

}  // namespace mcdbn::synthesis
