#pragma once

#include <cstdint>

#include "mcdbn/motion/keypoints.hpp"

namespace mcdbn {

/// Adds independent Gaussian noise to every joint's x and y, as a 2D pose estimator does; missing
/// joints stay missing. The same seed gives the same noise.
/// @param deviation_px standard deviation in pixels, 0 changes nothing
/// @throws ConfigError if it is negative or not finite
void add_pixel_noise(Track2d& track, double deviation_px, std::uint64_t seed);

}  // namespace mcdbn
