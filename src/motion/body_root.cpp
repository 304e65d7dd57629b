#include "motion/body_root.hpp"

#include <algorithm>

namespace mcdbn {

bool has_position(const Joint& joint) {
  return std::any_of(joint.channels.begin(), joint.channels.end(),
                     [](Channel channel) { return !is_rotation(channel); });
}

int only_child(const Skeleton& skeleton, int joint) {
  int child = -1;
  for (int i = joint + 1; i < skeleton.joint_count(); ++i) {
    if (skeleton.joints[i].parent != joint) continue;
    if (child >= 0) return -1;
    child = i;
  }
  return child;
}

int body_root(const Skeleton& skeleton) {
  if (skeleton.joints.empty()) return 0;
  int root = 0;
  for (int joint = 0; joint >= 0; joint = only_child(skeleton, joint)) {
    if (has_position(skeleton.joints[joint])) root = joint;
  }
  return root;
}

}  // namespace mcdbn
