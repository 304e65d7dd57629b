#pragma once

#include <algorithm>

#include "mcdbn/machines/crbm.hpp"

namespace mcdbn {

/// `count` rows to follow a sequence's end, for a look-ahead: the sequence mirrored about its last
/// row in time and in value, so that motion goes on at the same speed; beyond its length it stands
/// still. Binary units stay from 0 to 1.
/// @param sequence [frames x units], one frame at least  @return [count x units]
inline MatrixF mirrored_continuation(const MatrixF& sequence, Eigen::Index count,
                                     VisibleKind kind) {
  MatrixF rows(count, sequence.cols());
  const Eigen::Index last = sequence.rows() - 1;
  for (Eigen::Index i = 0; i < count; ++i)
    rows.row(i) = 2.0F * sequence.row(last) - sequence.row(std::max<Eigen::Index>(last - i - 1, 0));
  if (kind == VisibleKind::binary) rows = rows.cwiseMax(0.0F).cwiseMin(1.0F);
  return rows;
}

}  // namespace mcdbn
