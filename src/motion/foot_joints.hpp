#pragma once

#include <vector>

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// Joints whose name holds Foot, Toe or Ankle, in any case.
std::vector<int> foot_joints(const Skeleton& skeleton);

}  // namespace mcdbn
