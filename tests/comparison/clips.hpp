#pragma once

#include <random>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn::test {

/// Independent N(0,1) entries.
inline MatrixF random_clip(int frames, int columns, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<float> normal;
  return MatrixF::NullaryExpr(frames, columns, [&] { return normal(generator); });
}

}  // namespace mcdbn::test
