#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <random>

namespace mcdbn::synthesis {

/// std::mt19937_64 with transforms of our own: the standard's distributions differ between
/// libraries, so the same seed would give other clips elsewhere.
class Random {
 public:
  /// Independent streams for different keys (seed, subject, clip, …).
  explicit Random(std::initializer_list<std::uint64_t> keys);

  double uniform(double low, double high);
  /// Normal, redrawn beyond 2 deviations so that nobody walks on stilts.
  double normal(double mean, double deviation);
  bool chance(double probability) { return uniform(0, 1) < probability; }

 private:
  std::mt19937_64 engine_;
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
