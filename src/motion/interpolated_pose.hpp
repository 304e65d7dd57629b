#pragma once

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// A pose between two: rotations along the shortest way, positions along a straight line.
/// @param from, to [1 x channels]  @param part of the way, 0 to 1
/// @param previous channels that the angles go on from, those nearest of all equivalent ones
/// @return [1 x channels]
RowVectorD interpolated_pose(const Skeleton& skeleton, const RowVectorD& from, const RowVectorD& to,
                             double part, const RowVectorD& previous);

}  // namespace mcdbn
