#pragma once

#include <vector>

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// How far drawn motions are from the likeliest one: the root of the mean squared distance along
/// each axis of the world: of joint `root` and those above it where they are, of the others from
/// that joint. Nine of ten truths lie within 1.645 times that, if the draws are right and normal.
/// @param draws of the same joints and frames, their bones as long as they like
/// @return [frames x 3·joints] file units; 0 without draws
/// @throws ShapeError
MatrixD joint_uncertainty(const Motion& likeliest, const std::vector<Motion>& draws, int root = 0);

}  // namespace mcdbn
