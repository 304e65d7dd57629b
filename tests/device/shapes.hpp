#pragma once

#include <cstddef>
#include <vector>

namespace mcdbn::test {

/// C is [m x n], the sum runs over k.
struct ProductShape {
  std::size_t m, k, n;
};

/// 1, 3, primes and 4k + 1: every edge of tiles and vectors; so many rows that a product's columns
/// are packed.
inline const std::vector<ProductShape> kSmallShapes = {{1, 1, 1},   {3, 3, 3},    {1, 17, 3},
                                                       {3, 1, 17},  {7, 13, 5},   {13, 7, 17},
                                                       {17, 5, 33}, {11, 16, 16}, {157, 3, 33}};

/// The model's own: 96 or 190 visible units, five frames of them, 300 hidden ones, batch 100, and
/// the MRBM's 300 to 150; more rows, with columns packed in two panels.
inline const std::vector<ProductShape> kModelShapes = {
    {100, 96, 300},  {100, 300, 96},  {100, 190, 300}, {100, 300, 190}, {100, 480, 300},
    {100, 960, 190}, {100, 300, 150}, {101, 149, 37},  {165, 480, 300}};

}  // namespace mcdbn::test
