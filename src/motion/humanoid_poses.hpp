#pragma once

#include <array>
#include <vector>

#include "mcdbn/motion/humanoid.hpp"

namespace mcdbn {

/// The humanoid's motion as rotations, to be changed joint by joint.
class HumanoidPoses {
 public:
  /// @throws ShapeError if the skeleton is no humanoid
  explicit HumanoidPoses(const Motion& motion);

  int frames() const { return static_cast<int>(local_.size()); }
  double frame_time_s() const { return frame_time_s_; }
  /// parent_from_joint of a role's joint.
  Eigen::Matrix3d& local(int frame, JointRole role) { return local_[frame][index(role)]; }
  const Eigen::Matrix3d& local(int frame, JointRole role) const {
    return local_[frame][index(role)];
  }
  Eigen::Matrix3d world(int frame, JointRole role) const;  ///< world_from_joint
  /// Turns the joint, and all below it with it. The joints above stay.
  void set_world(int frame, JointRole role, const Eigen::Matrix3d& world_from_joint);

  MatrixD root;  ///< [frames x 3] the pelvis in the world, file units

  /// Height of the lowest ankle or toe. @return [frames]
  Eigen::VectorXd lowest_foot() const;
  /// On the same skeleton, angles continuous.
  Motion motion() const;

 private:
  static std::size_t index(JointRole role) { return static_cast<std::size_t>(role); }

  Skeleton skeleton_;
  double frame_time_s_;
  std::vector<std::array<Eigen::Matrix3d, kJointRoleCount>> local_;
};

/// The role of the joint above in the humanoid; the pelvis's own of the pelvis.
JointRole role_above(JointRole role);

/// Whether the joint of `role` hangs on that of `top`, or is it.
bool is_below(JointRole role, JointRole top);

}  // namespace mcdbn
