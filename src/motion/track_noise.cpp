#include "mcdbn/motion/track_noise.hpp"

#include <fmt/format.h>

#include <cmath>
#include <random>

#include "mcdbn/errors.hpp"

namespace mcdbn {

void add_pixel_noise(Track2d& track, double deviation_px, std::uint64_t seed) {
  if (!std::isfinite(deviation_px) || deviation_px < 0) {
    throw ConfigError(fmt::format("pixel noise is {}; give 0 or more pixels", deviation_px));
  }
  if (deviation_px == 0) return;
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> noise_px(0.0, deviation_px);
  for (MatrixD* coordinate_px : {&track.x_px, &track.y_px}) {
    *coordinate_px =
        coordinate_px->unaryExpr([&](double value) { return value + noise_px(generator); });
  }
}

}  // namespace mcdbn
