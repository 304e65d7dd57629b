#pragma once

#include <algorithm>

#include "base/random_matrix.hpp"
#include "mcdbn/machines/crbm.hpp"

namespace mcdbn::test {

/// Parameters without a zero, of sizes with which a decoder neither saturates nor dies out.
/// @param drive entries of W and B are at most drive / (drive + hidden)
inline CrbmParameters random_crbm(const CrbmShape& shape, unsigned seed, float drive) {
  CrbmParameters p = CrbmParameters::zeros(shape);
  const float scale = drive / (drive + static_cast<float>(shape.hidden));
  p.W = random_matrix(shape.visible, shape.hidden, seed, scale);
  p.A = random_matrix(
      shape.order_A() * shape.visible, shape.visible, seed + 1,
      0.5F / static_cast<float>(std::max<std::size_t>(shape.order_A(), 1) * shape.visible));
  p.B = random_matrix(shape.order_B() * shape.visible, shape.hidden, seed + 2, scale);
  p.a = random_matrix(1, shape.visible, seed + 3, 0.5F);
  p.b = random_matrix(1, shape.hidden, seed + 4, 0.5F);
  p.visible_mean = (0.5F * (random_matrix(1, shape.visible, seed + 5).array() + 1.0F)).matrix();
  return p;
}

/// The same with entries of the same size whatever the shape.
inline CrbmParameters random_layer(std::size_t visible, std::size_t hidden, std::size_t order,
                                   VisibleKind kind, unsigned seed) {
  CrbmParameters p = CrbmParameters::zeros({visible, hidden, order, kind});
  p.W = random_matrix(visible, hidden, seed, 0.4F);
  p.A = random_matrix(order * visible, visible, seed + 1, 0.1F);
  p.B = random_matrix(order * visible, hidden, seed + 2, 0.2F);
  p.a = random_matrix(1, visible, seed + 3, 0.3F);
  p.b = random_matrix(1, hidden, seed + 4, 0.3F);
  p.visible_mean = (0.5F * (random_matrix(1, visible, seed + 5).array() + 1.0F)).matrix();
  return p;
}

}  // namespace mcdbn::test
