#include "synthesis/synthesize_random.hpp"

#include <cmath>
#include <numbers>

namespace mcdbn::synthesis {
namespace {

/// Steele, Lea and Flood's finaliser: neighbouring seeds give unrelated streams.
std::uint64_t split_mix(std::uint64_t z) {
  z += 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

}  // namespace

Random::Random(std::initializer_list<std::uint64_t> keys) {
  std::uint64_t state = 0;
  for (const std::uint64_t key : keys) state = split_mix(state ^ key);
  engine_.seed(state);
}

double Random::uniform(double low, double high) {
  const double unit = static_cast<double>(engine_() >> 11) * 0x1p-53;
  return low + (high - low) * unit;
}

double Random::normal(double mean, double deviation) {
  constexpr double kLimit = 2.0;
  while (true) {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform(0, 1)));
    const double z = radius * std::cos(uniform(0, 2 * std::numbers::pi));
    if (std::abs(z) <= kLimit) return mean + deviation * z;
  }
}

SlowNoise::SlowNoise(Random& random, double deviation, double frequency_hz) {
  constexpr double kOctaveStep = 1.7;  // spreads the waves without common multiples
  double frequency = frequency_hz / kOctaveStep;
  const double amplitude = deviation * std::sqrt(2.0 / static_cast<double>(waves_.size()));
  for (Wave& wave : waves_) {
    wave.amplitude = amplitude;
    wave.radians_per_s = 2 * std::numbers::pi * frequency * random.uniform(0.85, 1.15);
    wave.phase = random.uniform(0, 2 * std::numbers::pi);
    frequency *= std::sqrt(kOctaveStep);
  }
}

double SlowNoise::operator()(double t_s) const {
  double sum = 0;
  for (const Wave& wave : waves_) {
    sum += wave.amplitude * std::sin(wave.radians_per_s * t_s + wave.phase);
  }
  return sum;
}

}  // namespace mcdbn::synthesis
