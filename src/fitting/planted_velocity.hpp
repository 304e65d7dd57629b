#pragma once

#include <vector>

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// The root's velocity as planted feet tell it: a foot that stands still moves the root by as much
/// as it moves against it. Feet count by how surely they are planted (kPlantedInAnswer, over the
/// lowest of the frame); where none is, in flight, the velocity that was given stays.
/// @param motion in the world, fps as it says  @param root joint  @param feet joints, may be none
/// @param velocity [frames x 3] of the root, world axes, file units per second: what else is known
/// @return the same shape  @throws ShapeError
MatrixD planted_velocity(const Motion& motion, int root, const std::vector<int>& feet,
                         const MatrixD& velocity);

}  // namespace mcdbn
