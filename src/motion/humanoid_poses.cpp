#include "motion/humanoid_poses.hpp"

#include "mcdbn/base/errors.hpp"

namespace mcdbn {

using enum JointRole;

HumanoidPoses::HumanoidPoses(const Motion& motion)
    : root(motion.channels.leftCols(3)),
      skeleton_(motion.skeleton),
      frame_time_s_(motion.frame_time_s),
      local_(static_cast<std::size_t>(motion.frames())) {
  if (!is_humanoid(skeleton_)) throw ShapeError("HumanoidPoses: not the humanoid's motion");
  for (const JointRole role : joint_roles()) {
    const int joint = humanoid_roles().joint(role), first = skeleton_.first_channel(joint);
    for (int t = 0; t < motion.frames(); ++t)
      local(t, role) =
          local_rotation(skeleton_.joints[joint], motion.channels.row(t).data() + first);
  }
}

Eigen::Matrix3d HumanoidPoses::world(int frame, JointRole role) const {
  Eigen::Matrix3d rotation = local(frame, role);
  for (JointRole at = role; at != pelvis;) {
    at = role_above(at);
    rotation = local(frame, at) * rotation;
  }
  return rotation;
}

void HumanoidPoses::set_world(int frame, JointRole role, const Eigen::Matrix3d& world_from_joint) {
  local(frame, role) = role == pelvis
                           ? world_from_joint
                           : (world(frame, role_above(role)).transpose() * world_from_joint).eval();
}

Eigen::VectorXd HumanoidPoses::lowest_foot() const {
  const MatrixD positions = joint_positions(motion());
  Eigen::VectorXd lowest = Eigen::VectorXd::Constant(frames(), positions.maxCoeff());
  for (const JointRole role : {left_ankle, left_toe, right_ankle, right_toe})
    lowest = lowest.cwiseMin(positions.col(3 * humanoid_roles().joint(role) + 1));
  return lowest;
}

Motion HumanoidPoses::motion() const {
  Motion motion{skeleton_, frame_time_s_, MatrixD(frames(), skeleton_.channel_count())};
  motion.channels.leftCols(3) = root;
  for (const JointRole role : joint_roles()) {
    const int joint = humanoid_roles().joint(role), first = skeleton_.first_channel(joint);
    for (int t = 0; t < frames(); ++t)
      set_local_rotation(skeleton_.joints[joint], local(t, role),
                         t > 0 ? motion.channels.row(t - 1).data() + first : nullptr,
                         motion.channels.row(t).data() + first);
  }
  return motion;
}

JointRole role_above(JointRole role) {
  const int parent = canonical_humanoid().joints[humanoid_roles().joint(role)].parent;
  return parent < 0 ? role : *humanoid_roles().role_of(parent);
}

bool is_below(JointRole role, JointRole top) {
  while (role != top && role != pelvis) role = role_above(role);
  return role == top;
}

}  // namespace mcdbn
