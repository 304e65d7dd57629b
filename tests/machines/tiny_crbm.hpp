#pragma once

#include "base/random_matrix.hpp"
#include "mcdbn/machines/crbm.hpp"

namespace mcdbn::test {

/// Parameters so large that all states do not come equally often, for machines whose states can be
/// counted.
inline CrbmParameters tiny_crbm(const CrbmShape& shape, unsigned seed, float scale = 1.0F) {
  CrbmParameters p = CrbmParameters::zeros(shape);
  const std::size_t history = shape.order * shape.visible;
  p.W = random_matrix(shape.visible, shape.hidden, seed, scale);
  p.A = random_matrix(history, shape.visible, seed + 1, 0.5F * scale);
  p.B = random_matrix(history, shape.hidden, seed + 2, 0.5F * scale);
  p.a = random_matrix(1, shape.visible, seed + 3, scale);
  p.b = random_matrix(1, shape.hidden, seed + 4, scale);
  if (shape.kind == VisibleKind::binary)
    p.visible_mean = (0.5F + 0.4F * random_matrix(1, shape.visible, seed + 5).array()).matrix();
  return p;
}

}  // namespace mcdbn::test
