#include "motion/body_size.hpp"

#include <algorithm>
#include <vector>

namespace mcdbn {

namespace {

constexpr double kLegOfHeight = 0.491;
constexpr double kBodyHeight_m = 1.7;

/// Joints whose offset is a position in the world, not a bone: the root, and below it every joint
/// with position channels that hangs on a chain of only children (Bandai's Hips).
std::vector<bool> positioned_in_world(const Skeleton& skeleton) {
  std::vector<int> children(skeleton.joints.size(), 0);
  for (const Joint& joint : skeleton.joints) {
    if (joint.parent >= 0) ++children[joint.parent];
  }
  std::vector<bool> positioned(skeleton.joints.size(), false);
  for (int j = 0; j < skeleton.joint_count(); ++j) {
    const Joint& joint = skeleton.joints[j];
    const bool moves = std::any_of(joint.channels.begin(), joint.channels.end(),
                                   [](Channel channel) { return !is_rotation(channel); });
    positioned[j] =
        joint.parent < 0 || (moves && positioned[joint.parent] && children[joint.parent] == 1);
  }
  return positioned;
}

}  // namespace

double body_height(const Skeleton& skeleton) {
  const std::vector<bool> positioned = positioned_in_world(skeleton);
  double longest_leg = 0;
  for (int j = 0; j < skeleton.joint_count(); ++j) {
    const int parent = skeleton.joints[j].parent;
    if (positioned[j] || positioned[parent]) continue;
    longest_leg = std::max(
        longest_leg, skeleton.joints[j].offset.norm() + skeleton.joints[parent].offset.norm());
  }
  return longest_leg > 0 ? longest_leg / kLegOfHeight : skeleton.rest_height();
}

double file_units_per_metre(const Skeleton& skeleton) {
  const double height = body_height(skeleton);
  // A single point has no size; one unit a metre keeps its numbers finite.
  return height > 0 ? height / kBodyHeight_m : 1.0;
}

}  // namespace mcdbn
