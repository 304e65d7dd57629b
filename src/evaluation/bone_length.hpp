#pragma once

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// Mean over bones of the standard deviation of a bone's length over the frames, in millimetres: 0
/// for a rigid skeleton, more where position channels stretch it or joints were placed one by one.
/// A bone joins a joint to its parent; what ends at the root or above it is travel, no bone. 0 for
/// a skeleton without bones.
/// @param positions [frames x 3·joints] in millimetres  @param root the joint that carries the body
/// @throws ShapeError
double bone_length_spread_mm(const MatrixD& positions, const Skeleton& skeleton, int root);

}  // namespace mcdbn
