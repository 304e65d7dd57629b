#pragma once

#include <cmath>

#include "mcdbn/corpus/clip.hpp"
#include "motion/humanoid_motion.hpp"

namespace mcdbn::test {

/// A clip of the moving humanoid whose elbows keep one bend, whose knees another, and which looks
/// the same way throughout.
inline LoadedClip humanoid_clip(double elbow_deg, double knee_deg, double heading_deg,
                                int frames = 90) {
  using enum JointRole;
  Motion motion = moving_humanoid(frames);
  const auto set = [&](JointRole role, double deg, const Eigen::Vector3d& axis) {
    const int joint = humanoid_roles().joint(role);
    const Eigen::Matrix3d rotation = Eigen::AngleAxisd(deg * M_PI / 180, axis).toRotationMatrix();
    for (int t = 0; t < frames; ++t)
      set_local_rotation(motion.skeleton.joints[static_cast<std::size_t>(joint)], rotation, nullptr,
                         motion.channels.row(t).data() + motion.skeleton.first_channel(joint));
  };
  set(left_elbow, -elbow_deg, Eigen::Vector3d::UnitY());
  set(right_elbow, elbow_deg, Eigen::Vector3d::UnitY());
  set(left_knee, knee_deg, Eigen::Vector3d::UnitX());
  set(right_knee, knee_deg, Eigen::Vector3d::UnitX());
  set(pelvis, heading_deg, Eigen::Vector3d::UnitY());
  return {{}, std::move(motion)};
}

inline double angle_deg(const Eigen::Matrix3d& rotation) {
  return Eigen::AngleAxisd(rotation).angle() * 180 / M_PI;
}

}  // namespace mcdbn::test
