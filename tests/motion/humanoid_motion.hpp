#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "mcdbn/motion/humanoid.hpp"

namespace mcdbn::test {

/// The humanoid on the move: it turns on the spot, bends, swings its arms; elbows and knees bend
/// their own way alone.
inline Motion moving_humanoid(int frames = 60) {
  using enum JointRole;
  const Skeleton& skeleton = canonical_humanoid();
  Motion motion{skeleton, 1.0 / 30, MatrixD::Zero(frames, skeleton.channel_count())};
  for (int t = 0; t < frames; ++t) {
    const double s = 0.2 * t;
    double* row = motion.channels.row(t).data();
    row[0] = 40 * std::sin(0.3 * s), row[1] = 96 + 2 * std::sin(s), row[2] = 3 * s;
    const auto turn = [&](JointRole role, double x_deg, double y_deg, double z_deg) {
      const int joint = humanoid_roles().joint(role);
      const Eigen::Vector3d deg(x_deg, y_deg, z_deg);
      const Eigen::Matrix3d rotation =
          Eigen::AngleAxisd(deg.norm() * M_PI / 180, deg.normalized()).toRotationMatrix();
      set_local_rotation(skeleton.joints[joint], rotation, nullptr,
                         row + skeleton.first_channel(joint));
    };
    turn(pelvis, 6 * std::sin(s), 200 * std::sin(0.2 * s), 4 * std::cos(s));
    turn(spine, 9 * std::sin(s + 1), 6 * std::sin(s), 0);
    turn(chest, 7 * std::sin(s + 2), 5 * std::cos(s), 3 * std::sin(s));
    turn(neck, 8 * std::sin(s + 3), 0, 5 * std::sin(s));
    turn(head, 10 * std::sin(s + 4), 20 * std::sin(s), 0);
    for (const bool right : {false, true}) {
      const double side = right ? -1 : 1, p = s + (right ? M_PI : 0);
      const auto of = [&](JointRole left) { return right ? other_side(left) : left; };
      turn(of(left_clavicle), 0, 0, side * 6 * std::sin(p));
      turn(of(left_shoulder), 15 * std::sin(p), side * 10 * std::cos(p), side * -65);
      turn(of(left_elbow), 0, side * (-40 - 30 * std::sin(p)), 0);
      turn(of(left_wrist), 12 * std::sin(p), 0, side * 6);
      turn(of(left_hip), -15 + 25 * std::sin(p), 3, side * 5 * std::sin(p));
      turn(of(left_knee), 35 + 30 * std::sin(p + 1), 0, 0);
      turn(of(left_ankle), 10 * std::sin(p), 2, 0);
      turn(of(left_toe), -6 - 5 * std::sin(p), 0, 0);
    }
  }
  return motion;
}

/// The same with every joint turning by Z X Y, as the humanoid once did.
inline Motion on_former_orders(const Motion& motion) {
  Motion result = motion;
  for (int j = 0; j < motion.skeleton.joint_count(); ++j) {
    const Joint& was = motion.skeleton.joints[static_cast<std::size_t>(j)];
    Joint& now = result.skeleton.joints[static_cast<std::size_t>(j)];
    std::copy_n(std::array{Channel::z_rotation, Channel::x_rotation, Channel::y_rotation}.begin(),
                3, now.channels.end() - 3);
    const int first = motion.skeleton.first_channel(j);
    for (int t = 0; t < motion.frames(); ++t)
      set_local_rotation(now, local_rotation(was, motion.channels.row(t).data() + first), nullptr,
                         result.channels.row(t).data() + first);
  }
  return result;
}

/// World orientations of all joints of a frame, one beside another.
inline MatrixD turns_of(const Motion& motion, int frame) {
  const WorldPose pose = forward_kinematics(motion.skeleton, motion.channels.row(frame));
  MatrixD all(3, 3 * motion.skeleton.joint_count());
  for (int j = 0; j < motion.skeleton.joint_count(); ++j)
    all.middleCols<3>(3 * j) = pose.world_from_joint[static_cast<std::size_t>(j)];
  return all;
}

/// Of places in units and of turns in radians, over all frames of two motions on the humanoid.
inline double largest_difference(const Motion& a, const Motion& b) {
  double most = (joint_positions(a) - joint_positions(b)).cwiseAbs().maxCoeff();
  for (int t = 0; t < a.frames(); ++t)
    most = std::max(most, (turns_of(a, t) - turns_of(b, t)).cwiseAbs().maxCoeff());
  return most;
}

}  // namespace mcdbn::test
