#pragma once

#include <vector>

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// No joint turned, the root at the origin.
/// @param local where each joint is on its parent
inline WorldPose rest_pose(const Skeleton& skeleton, const std::vector<Eigen::Vector3d>& local) {
  WorldPose pose;
  for (int j = 0; j < skeleton.joint_count(); ++j) {
    const int parent = skeleton.joints[j].parent;
    pose.world_from_joint.emplace_back(Eigen::Matrix3d::Identity());
    pose.position.push_back(parent < 0 ? Eigen::Vector3d(0, 0, 0)
                                       : Eigen::Vector3d(pose.position[parent] + local[j]));
  }
  return pose;
}

/// No joint turned, each at its offset, but the root at the origin.
inline WorldPose rest_pose(const Skeleton& skeleton) {
  std::vector<Eigen::Vector3d> offsets;
  for (const Joint& joint : skeleton.joints) offsets.push_back(joint.offset);
  return rest_pose(skeleton, offsets);
}

}  // namespace mcdbn
