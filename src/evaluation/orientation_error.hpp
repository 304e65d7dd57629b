#pragma once

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// Mean angle between the true orientation of a joint in the world and the regenerated one, over
/// frames and all joints of the truth that turn and that the answer has (MPJAE). It shows what no
/// joint's place does: how a limb is turned about its own length, and which way a trunk faces.
/// @param truth, regenerated as many frames; joints are matched by name
/// @return degrees, 0 to 180; NaN without such a joint
/// @throws ShapeError if frames differ
double mpjae_deg(const Motion& truth, const Motion& regenerated);

}  // namespace mcdbn
