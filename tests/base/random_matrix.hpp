#pragma once

#include <random>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn::test {

/// Entries uniform in [−scale, scale]; the same for the same seed.
inline MatrixF random_matrix(std::size_t rows, std::size_t columns, unsigned seed,
                             float scale = 1.0F) {
  std::mt19937 generator(seed);
  return MatrixF::NullaryExpr(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns),
                              [&] {
                                const auto bits = static_cast<float>(generator() >> 8);
                                return scale * (bits * 0x1p-23F - 1.0F);
                              });
}

}  // namespace mcdbn::test
