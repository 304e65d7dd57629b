#include "mcdbn/motion/retarget_error.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "base/numbers.hpp"
#include "motion/body_size.hpp"
#include "motion/rig_axes.hpp"

namespace mcdbn {
namespace {

double mean_of(const std::vector<RetargetError::OfJoint>& joints,
               double RetargetError::OfJoint::*member) {
  double sum = 0;
  for (const auto& joint : joints) sum += joint.*member;
  return joints.empty() ? 0 : sum / static_cast<double>(joints.size());
}

}  // namespace

double RetargetError::mean_deg() const {
  return mean_of(joints, &OfJoint::mean_deg);
}

double RetargetError::mean_mm() const {
  return mean_of(joints, &OfJoint::mean_mm);
}

double RetargetError::humanoid_mm() const {
  return mean_of(joints, &OfJoint::humanoid_mm);
}

const RetargetError::OfJoint& RetargetError::worst_turned() const {
  return *std::ranges::max_element(joints, {}, &OfJoint::worst_deg);
}

const RetargetError::OfJoint& RetargetError::worst_placed() const {
  return *std::ranges::max_element(joints, {}, &OfJoint::worst_mm);
}

RetargetError retarget_error(const HumanoidRig& rig, const Motion& motion) {
  constexpr int kMostFrames = 200;
  Motion some{motion.skeleton, motion.frame_time_s, {}};
  some.channels = motion.channels(spread_frames(motion, kMostFrames), Eigen::all);
  const Motion humanoid = rig.to_humanoid(some), back = rig.from_humanoid(humanoid);
  const double mm = 1000.0 / file_units_per_metre(motion.skeleton);
  RetargetError error;
  const std::vector<int> kept = rig.kept_joints();
  for (const int joint : kept) error.joints.push_back({motion.skeleton.joints[joint].name});
  for (int t = 0; t < some.frames(); ++t) {
    const WorldPose was = forward_kinematics(some.skeleton, some.channels.row(t)),
                    is = forward_kinematics(back.skeleton, back.channels.row(t)),
                    there = forward_kinematics(humanoid.skeleton, humanoid.channels.row(t));
    for (std::size_t k = 0; k < kept.size(); ++k) {
      const auto joint = static_cast<std::size_t>(kept[k]);
      const double deg = Eigen::Quaterniond(was.world_from_joint[joint])
                             .angularDistance(Eigen::Quaterniond(is.world_from_joint[joint])) /
                         kRadiansPerDegree,
                   off_mm = mm * (was.position[joint] - is.position[joint]).norm();
      RetargetError::OfJoint& of = error.joints[k];
      of.mean_deg += deg / some.frames();
      of.mean_mm += off_mm / some.frames();
      if (const auto role = rig.roles().role_of(kept[k]))
        of.humanoid_mm += mm / some.frames() *
                          (was.position[joint] -
                           there.position[static_cast<std::size_t>(humanoid_roles().joint(*role))])
                              .norm();
      of.worst_deg = std::max(of.worst_deg, deg);
      of.worst_mm = std::max(of.worst_mm, off_mm);
    }
  }
  return error;
}

}  // namespace mcdbn
