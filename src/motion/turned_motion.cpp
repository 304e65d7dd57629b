#include "motion/turned_motion.hpp"

#include <algorithm>

#include "mcdbn/base/errors.hpp"
#include "motion/body_root.hpp"

namespace mcdbn {
namespace {

/// The first joint with three rotations of joint 0 and its chain of only children.
int turning_joint(const Skeleton& skeleton) {
  int joint = skeleton.joints.empty() ? -1 : 0;
  while (joint >= 0 && std::ranges::count_if(skeleton.joints[joint].channels, is_rotation) < 3)
    joint = only_child(skeleton, joint);
  if (joint < 0)
    throw InputError(
        "no joint turns the whole body; give the first one, or one that is alone below it, 3 "
        "rotation channels");
  return joint;
}

/// The nearest joint with position channels from `joint` upwards, or -1. All stand on the chain,
/// each right after its parent.
int carrying_joint(const Skeleton& skeleton, int joint) {
  while (joint >= 0 && !has_position(skeleton.joints[joint])) --joint;
  return joint;
}

Eigen::Matrix3d world_from_parent(const Skeleton& skeleton, const WorldPose& pose, int joint) {
  const int parent = skeleton.joints[joint].parent;
  return parent < 0 ? Eigen::Matrix3d(Eigen::Matrix3d::Identity()) : pose.world_from_joint[parent];
}

/// @param step along the axes of the joint's parent, file units
void move_joint(const Joint& joint, const Eigen::Vector3d& step, double* channels) {
  for (std::size_t k = 0; k < joint.channels.size(); ++k)
    if (!is_rotation(joint.channels[k])) channels[k] += step[axis_of(joint.channels[k])];
}

}  // namespace

Motion turned_motion(Motion motion, const Eigen::Matrix3d& turn, const Eigen::VectorXd& raised_by) {
  const Skeleton& skeleton = motion.skeleton;
  const int turning = turning_joint(skeleton), carrying = carrying_joint(skeleton, turning);
  const int first = skeleton.first_channel(turning);
  for (Eigen::Index t = 0; t < motion.frames(); ++t) {
    const WorldPose pose = forward_kinematics(skeleton, motion.channels.row(t));
    double* channels = motion.channels.row(t).data();
    Eigen::Vector3d step = turn * pose.position[turning] - pose.position[turning];
    if (raised_by.size() > 0) step.y() += raised_by[t];
    if (carrying >= 0)
      move_joint(skeleton.joints[carrying],
                 world_from_parent(skeleton, pose, carrying).transpose() * step,
                 channels + skeleton.first_channel(carrying));
    set_local_rotation(skeleton.joints[turning],
                       world_from_parent(skeleton, pose, turning).transpose() * turn *
                           pose.world_from_joint[turning],
                       t > 0 ? motion.channels.row(t - 1).data() + first : nullptr,
                       channels + first);
  }
  return motion;
}

}  // namespace mcdbn
