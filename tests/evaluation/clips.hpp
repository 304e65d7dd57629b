#pragma once

#include <random>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn::test {

/// Independent entries, normal with the given standard deviation.
inline MatrixD random_clip(int frames, int channels, double deviation, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal(0, deviation);
  return MatrixD::NullaryExpr(frames, channels, [&] { return normal(generator); });
}

}  // namespace mcdbn::test
