#pragma once

#include <utility>
#include <vector>

#include "mcdbn/camera/keypoint.hpp"

namespace mcdbn {

/// The columns of both legs, or of both arms, left before right: the same place on both sides, a
/// column in one pair at most.
struct LimbPairs {
  std::vector<std::pair<int, int>> columns;  ///< all that move when the limbs are exchanged
  std::vector<std::pair<int, int>> distal;   ///< of them those that are far from the trunk
};

/// Hips, knees, ankles and what the feet carry; distal are knees and ankles.
LimbPairs leg_pairs(const std::vector<Keypoint>& keypoints);
/// Shoulders, elbows, wrists and hands; distal are elbows and wrists.
LimbPairs arm_pairs(const std::vector<Keypoint>& keypoints);

}  // namespace mcdbn
