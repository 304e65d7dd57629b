#pragma once

#include <Eigen/Core>
#include <array>

#include "mcdbn/motion/skeleton.hpp"
#include "synthesis/synthesize_random.hpp"

namespace mcdbn::synthesis {

enum Side { kLeft = 0, kRight = 1 };
constexpr std::array<Side, 2> kSides{kLeft, kRight};
/// +1 on the left, where x grows, and −1 on the right.
constexpr double sign_of(Side side) {
  return side == kLeft ? 1.0 : -1.0;
}

Eigen::Matrix3d rotation_x(double angle_deg);
Eigen::Matrix3d rotation_y(double angle_deg);
Eigen::Matrix3d rotation_z(double angle_deg);

/// Segment lengths of one person, cm: stature times Drillis and Contini's fractions, each varied a
/// little.
struct Body {
  double stature, thigh, shank, ankle_height, heel_back, ball_forward, toe_length;
  double hip_half_width, hip_drop, spine_rise, chest_rise, neck_rise, head_rise, head_length;
  double clavicle_out, clavicle_rise, shoulder_out, upper_arm, forearm, hand;

  static Body draw(Random& random);

  double leg() const { return thigh + shank; }
  /// Height of the Hips joint over flat feet with straight legs.
  double straight_hips_height() const { return ankle_height + leg() + hip_drop; }
  Eigen::Vector3d hip_offset(Side side) const;       ///< in the Hips' frame
  Eigen::Vector3d clavicle_offset(Side side) const;  ///< in the Chest's frame
  Eigen::Vector3d shoulder_offset(Side side) const;  ///< of the arm, in the clavicle's frame
  /// In the foot's frame, whose origin is the ankle.
  Eigen::Vector3d heel_offset() const { return {0, -ankle_height, -heel_back}; }
  Eigen::Vector3d ball_offset() const { return {0, kBallHeight - ankle_height, ball_forward}; }
  static constexpr double kBallHeight = 2.0;  ///< of the ToeBase joint over the ground
};

/// How this person moves, in every action.
struct Style {
  double tempo;         ///< 1 is usual
  double amplitude;     ///< 1 is usual
  double lean_deg;      ///< forward, of the trunk
  double head_nod_deg;  ///< forward
  double arm_out_deg;   ///< how far the hanging arms stand off
  double elbow_deg;     ///< how far the hanging arms are bent
  double arm_swing;     ///< 1 is usual
  double toe_out_deg;
  double stance_width;  ///< as a fraction of the hips' width

  static Style draw(Random& random);
};

/// Joints in the skeleton's order; legs and arms come as blocks of four, left first.
enum JointIndex {
  kHips,
  kSpine,
  kChest,
  kNeck,
  kHead,
  kLeftShoulder,
  kLeftArm,
  kLeftForeArm,
  kLeftHand,
  kRightShoulder,
  kRightArm,
  kRightForeArm,
  kRightHand,
  kLeftUpLeg,
  kLeftLeg,
  kLeftFoot,
  kLeftToeBase,
  kRightUpLeg,
  kRightLeg,
  kRightFoot,
  kRightToeBase,
  kJointCount
};
constexpr int arm_block(Side side) {
  return side == kLeft ? kLeftShoulder : kRightShoulder;
}
constexpr int leg_block(Side side) {
  return side == kLeft ? kLeftUpLeg : kRightUpLeg;
}

/// T-pose at rest, facing +z, left along +x, centimetres.
Skeleton make_skeleton(const Body& body);

}  // namespace mcdbn::synthesis
