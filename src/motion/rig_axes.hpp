#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mcdbn/motion/skeleton_roles.hpp"

namespace mcdbn {

/// How the joints of a skeleton are turned when its body stands in the canonical humanoid's rest
/// pose.
struct RigAxes {
  /// By role, joint_from_humanoid: world_from_joint times it is the orientation of the humanoid's
  /// joint. Identity where the skeleton has no such joint.
  std::array<Eigen::Matrix3d, kJointRoleCount> by_role;
  /// Whether they are from the rest pose: it stands as a body does, however its arms are held.
  bool from_rest = true;

  const Eigen::Matrix3d& of(JointRole role) const {
    return by_role[static_cast<std::size_t>(role)];
  }
};

/// From the rest pose, where that is a body's: left, up and forward by hips and spine, then each
/// bone turned the shortest way to where the humanoid's points, from how the bone above it is
/// turned. Where it is no body's (Bandai's bones all lie along x) from the motion: hips and
/// shoulders determine how the trunk is turned; elbows and knees bend one way only, which shows how
/// an upper arm or a thigh is turned about its length, to the joint's own axis if one is within 35
/// degrees, as such rigs are built along axes; what is below goes on as that does if its bone lies
/// in it alike.
RigAxes rig_axes(const Motion& motion, const SkeletonRoles& roles);

/// At most `most` frames of a clip, evenly spaced; the first and the last among them.
std::vector<int> spread_frames(const Motion& motion, int most);

}  // namespace mcdbn
