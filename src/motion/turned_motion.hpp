#pragma once

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// The motion in other axes of the world, about its origin.
/// @param turn a rotation  @throws ShapeError if joint 0 cannot turn
Motion turned_motion(Motion motion, const Eigen::Matrix3d& turn);

}  // namespace mcdbn
