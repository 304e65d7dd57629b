#include "fitting/turned_bones.hpp"

#include "motion/joint_matching.hpp"

namespace mcdbn {

bool is_same_or_below(const std::vector<int>& parents, int turn, int other) {
  while (turn >= 0 && turn != other) turn = parents[static_cast<std::size_t>(turn)];
  return turn == other;
}

TurnedBones::TurnedBones(const PoseFeatures& features, const Skeleton& skeleton,
                         const std::vector<int>& joints) {
  const std::vector<int> match = match_joints(features.skeleton(), skeleton, "the skeleton");
  root_ = match[features.root()];
  std::vector<int> turn_of(skeleton.joints.size(), -1);
  for (std::size_t turn = 0; turn < features.joints().size(); ++turn) {
    turn_of[match[features.joints()[turn]]] = static_cast<int>(turn);
  }
  const auto turn_at_or_above = [&](int joint) {
    while (joint >= 0 && turn_of[joint] < 0) joint = skeleton.joints[joint].parent;
    return joint < 0 ? -1 : turn_of[joint];
  };
  for (std::size_t turn = 0; turn < features.joints().size(); ++turn) {
    const int joint = match[features.joints()[turn]];
    const int parent = turn_at_or_above(skeleton.joints[joint].parent);
    // Another skeleton may have another tree; an orientation that comes later is no parent.
    parents_.push_back(parent < static_cast<int>(turn) ? parent : -1);
  }
  for (const Joint& joint : skeleton.joints) turn_above_.push_back(turn_at_or_above(joint.parent));
  for (const int joint : joints) {
    std::vector<Bone> bones;
    for (int lower = joint; lower != root_ && lower >= 0; lower = skeleton.joints[lower].parent) {
      const int upper = skeleton.joints[lower].parent, turn = turn_at_or_above(upper);
      if (turn >= 0) bones.push_back({turn, upper, lower});
    }
    bones_of_joint_.push_back(std::move(bones));
  }
}

std::vector<std::vector<Lever>> TurnedBones::levers(
    const WorldPose& pose, const Eigen::Matrix3d& camera_from_world) const {
  std::vector<std::vector<Lever>> result;
  for (const std::vector<Bone>& bones : bones_of_joint_) {
    std::vector<Lever> levers;
    for (const Bone& bone : bones) {
      const Eigen::Vector3d vector =
          camera_from_world * (pose.position[bone.lower] - pose.position[bone.upper]);
      if (levers.empty() || levers.back().turn != bone.turn) {
        levers.push_back({bone.turn, vector});
      } else {
        levers.back().bone += vector;
      }
    }
    result.push_back(std::move(levers));
  }
  return result;
}

}  // namespace mcdbn
