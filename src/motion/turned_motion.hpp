#pragma once

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// The motion in other axes of the world, about its origin. The first joint that turns of joint 0
/// and its chain of only children takes all below it with it; nodes above it stay.
/// @param turn a rotation
/// @param raised_by [frames] how much higher (y) the body then stands, file units; empty: as high
/// @throws InputError if none of these joints turns
Motion turned_motion(Motion motion, const Eigen::Matrix3d& turn,
                     const Eigen::VectorXd& raised_by = {});

}  // namespace mcdbn
