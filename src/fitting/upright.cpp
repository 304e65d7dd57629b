#include "fitting/upright.hpp"

#include "motion/foot_joints.hpp"

namespace mcdbn {

Eigen::Vector3d upright_in_camera(const Motion& motion, const Camera& camera) {
  const Skeleton& skeleton = motion.skeleton;
  const std::vector<int> feet = foot_joints(skeleton);
  if (feet.empty()) return camera.camera_from_world.col(1);
  const Eigen::RowVectorXd mean = joint_positions(motion).colwise().mean();
  Eigen::Vector3d upright(0, 0, 0);
  // What stands above the joint that carries the body stays at the world's origin.
  const int root = moving_root({&motion}), joints = skeleton.joint_count() - root;
  for (int joint = root; joint < skeleton.joint_count(); ++joint)
    upright += mean.segment<3>(3 * joint).transpose() / joints;
  for (const int foot : feet)
    upright -= mean.segment<3>(3 * foot).transpose() / static_cast<double>(feet.size());
  return camera.camera_from_world * upright;
}

}  // namespace mcdbn
