#include "fitting/stance.hpp"

#include <algorithm>

#include "motion/foot_joints.hpp"

namespace mcdbn {
namespace {

struct Leg {
  int hip, ankle;
  double length;
};

/// An ankle is a foot's first joint, and two bones hang between it and the hip.
std::vector<Leg> legs_of(const Skeleton& skeleton, const std::vector<int>& feet) {
  std::vector<Leg> legs;
  for (const int ankle : feet) {
    const Joint& end = skeleton.joints[static_cast<std::size_t>(ankle)];
    if (end.parent < 0 || std::ranges::find(feet, end.parent) != feet.end()) continue;
    const Joint& knee = skeleton.joints[static_cast<std::size_t>(end.parent)];
    const double length = end.offset.norm() + knee.offset.norm();
    if (knee.parent >= 0 && length > 0) legs.push_back({knee.parent, ankle, length});
  }
  return legs;
}

double bent_share(const MatrixD& positions, const std::vector<Leg>& legs) {
  double sum = 0;
  for (const Leg& leg : legs)
    sum += 1 - (positions.middleCols<3>(3 * leg.hip) - positions.middleCols<3>(3 * leg.ankle))
                       .rowwise()
                       .norm()
                       .mean() /
                   leg.length;
  return legs.empty() ? 0 : std::max(0.0, sum / static_cast<double>(legs.size()));
}

}  // namespace

Stance stance_in_camera(const Motion& motion, const Camera& camera) {
  const Skeleton& skeleton = motion.skeleton;
  const std::vector<int> feet = foot_joints(skeleton);
  if (feet.empty()) return {camera.camera_from_world.col(1)};
  const MatrixD positions = joint_positions(motion);
  const Eigen::RowVectorXd mean = positions.colwise().mean();
  Eigen::Vector3d upright(0, 0, 0);
  // Joints above the one that carries the body are no part of it.
  const int root = moving_root({&motion}), joints = skeleton.joint_count() - root;
  for (int joint = root; joint < skeleton.joint_count(); ++joint)
    upright += mean.segment<3>(3 * joint).transpose() / joints;
  for (const int foot : feet)
    upright -= mean.segment<3>(3 * foot).transpose() / static_cast<double>(feet.size());
  return {camera.camera_from_world * upright, bent_share(positions, legs_of(skeleton, feet))};
}

Stance mean_stance(const Stance& one, double frames_of_one, const Stance& other,
                   double frames_of_other) {
  const double frames = frames_of_one + frames_of_other;
  if (!(frames > 0)) return {};
  const double share = frames_of_other / frames;
  return {(1 - share) * one.upright + share * other.upright,
          (1 - share) * one.bent_legs + share * other.bent_legs};
}

}  // namespace mcdbn
