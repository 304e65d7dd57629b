#include "synthesis/synthesize_random.hpp"

#include <cmath>
#include <numbers>

namespace mcdbn::synthesis {
double Random::normal(double mean, double deviation) {
  constexpr double kLimit = 2.0;
  while (true) {
    const double z = RandomSequence::normal();
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
