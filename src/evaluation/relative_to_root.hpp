#pragma once

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

/// @param positions [frames x 3·joints]  @return the same with joint `root_joint` taken from each
inline MatrixD relative_to_root(const MatrixD& positions, int root_joint) {
  return positions - positions.middleCols<3>(3 * root_joint).replicate(1, positions.cols() / 3);
}

}  // namespace mcdbn
