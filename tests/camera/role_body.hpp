#pragma once

#include "mcdbn/motion/skeleton_roles.hpp"
#include "motion/synthetic_motion.hpp"

namespace mcdbn::test {

/// A body of 170 units that stands in its rest pose, arms down, and faces +z.
inline Skeleton role_body() {
  const std::vector<Channel> zxy{z_rotation, x_rotation, y_rotation};
  Skeleton body;
  body.joints = {
      make_joint("Hips", -1, {0, 0, 0},
                 {x_position, y_position, z_position, z_rotation, x_rotation, y_rotation}),
      make_joint("Neck", 0, {0, 50, 0}, zxy), make_joint("Head", 1, {0, 12, 0}, zxy)};
  for (const double side : {1.0, -1.0}) {
    const std::string name = side > 0 ? "Left" : "Right";
    const int first = body.joint_count();
    body.joints.push_back(make_joint(name + "UpLeg", 0, {9 * side, -5, 0}, zxy));
    body.joints.push_back(make_joint(name + "Leg", first, {0, -41.7, 0}, zxy));
    body.joints.push_back(make_joint(name + "Foot", first + 1, {0, -41.8, 0}, zxy));
    body.joints.push_back(make_joint(name + "Arm", 1, {18 * side, -4, 0}, zxy));
    body.joints.push_back(make_joint(name + "ForeArm", first + 3, {2 * side, -30, 0}, zxy));
    body.joints.push_back(make_joint(name + "Hand", first + 4, {0, -26, 0}, zxy));
  }
  return body;
}

inline SkeletonRoles roles_of_role_body() {
  using enum JointRole;
  SkeletonRoles roles;
  int joint = 0;
  for (const JointRole role :
       {pelvis, neck, head, left_hip, left_knee, left_ankle, left_shoulder, left_elbow, left_wrist,
        right_hip, right_knee, right_ankle, right_shoulder, right_elbow, right_wrist})
    roles.set(role, joint++);
  return roles;
}

/// Stands still, the hips 90 units above the origin.
inline Motion standing_still(const Skeleton& body, int frames) {
  Motion motion;
  motion.skeleton = body;
  motion.channels = MatrixD::Zero(frames, body.channel_count());
  motion.channels.col(1).setConstant(90);
  return motion;
}

}  // namespace mcdbn::test
