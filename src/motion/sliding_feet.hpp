#pragma once

#include <vector>

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// In what share of the steps to these frames all feet slide: every foot joint moves along the
/// ground faster than one that is planted (kPlantedInAnswer), and clearly faster than the body's
/// root. One who walks, runs or stands on ground at rest has a foot that is slower than the hips;
/// one whose camera is turned after them, or who walks on a treadmill, has none. Measured: at most
/// 0.31 in 130 answers to cameras that stand still, of people who walk, run, jump and dance; 0.59
/// and 0.89 in two whose camera was turned after a walker and a runner, 0.67 to 0.82 on treadmills.
/// @param frames [frames] which to look at
/// @return 0 to 1; 0 without such frames, or without feet (foot_joints)
/// @throws ShapeError
double share_of_sliding(const Motion& motion, const std::vector<bool>& frames);

}  // namespace mcdbn
