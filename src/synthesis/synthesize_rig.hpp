#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "synthesis/synthesize_body.hpp"

namespace mcdbn::synthesis {

/// What an action sets of the body above the legs, in degrees; 0 is standing upright with the arms
/// straight down, palms in.
enum Dof {
  kPelvisTurn,  ///< to the left
  kPelvisTilt,  ///< forward
  kPelvisLean,  ///< to the right
  kTrunkFlex,   ///< forward, shared by Spine and Chest
  kTrunkBend,   ///< to the right
  kTrunkTwist,  ///< to the left
  kHeadNod,     ///< forward, shared by Neck and Head
  kHeadTilt,    ///< to the right
  kHeadTurn,    ///< to the left
  kArmDofs,     ///< here begin the arms, left before right
  kDofCount = kArmDofs + 12
};
enum ArmDof {
  kShrug,      ///< clavicle upwards
  kFlexion,    ///< arm forwards and up
  kAbduction,  ///< arm sideways and up
  kTwist,      ///< of the upper arm, inwards
  kElbow,      ///< flexion
  kWrist,      ///< flexion, to the palm
  kArmDofCount
};
constexpr int arm_dof(Side side, ArmDof dof) {
  return int{kArmDofs} + int{side} * int{kArmDofCount} + int{dof};
}

using Posture = Eigen::Matrix<double, kDofCount, 1>;

/// How a person of that style stands.
Posture standing_posture(const Style& style);

/// One leg's end: the leg itself follows by inverse kinematics.
struct Foot {
  Eigen::Vector3d ankle{0, 0, 0};  ///< world
  double turn_deg = 0;             ///< to the left, in the world
  double pitch_deg = 0;            ///< toes up
  double toe_bend_deg = 0;         ///< toes up against the foot
  bool planted = false;            ///< has to be reached, whatever that asks of the hips
};

/// Where a flat foot stands on the ground.
struct FootPrint {
  Eigen::Vector3d ankle{0, 0, 0};  ///< world, at the height that the flat foot gives it
  double turn_deg = 0;
};

/// The foot rolled over heel (pitch above 0) or ball (below 0, toes flat) on that print: the point
/// that it rolls over stays where it is.
Foot planted_foot(const Body& body, const FootPrint& print, double pitch_deg);

struct ArmPose {
  Eigen::Matrix3d upper;  ///< in the clavicle's frame
  double elbow_deg;
  Eigen::Matrix3d hand;  ///< in the forearm's frame
};
/// The arm as the posture has it.
ArmPose arm_pose(const Posture& posture, Side side);
/// The arm that brings the wrist to a point. @param wrist in the Chest's frame, the clavicle at
/// rest  @param elbow_direction, hand_direction where they point, in the same frame
ArmPose reaching_arm(const Body& body, Side side, const Eigen::Vector3d& wrist,
                     const Eigen::Vector3d& elbow_direction, const Eigen::Vector3d& hand_direction);
ArmPose blend(const ArmPose& from, const ArmPose& to, double weight);

/// Feet side by side, under hips at x = z = 0 that face +z.
std::array<FootPrint, 2> standing_prints(const Body& body, const Style& style);

/// One frame before inverse kinematics.
struct Frame {
  Eigen::Vector3d hips{0, 0, 0};  ///< world
  double heading_deg = 0;         ///< to the left of +z
  Posture posture = Posture::Zero();
  std::array<std::optional<ArmPose>, 2> arms;  ///< as the posture has them where unset
  std::array<Foot, 2> feet;
};

/// Lowers the hips, smoothly over time, wherever a leg could not reach its planted foot, solves the
/// legs, and writes the channels of `make_skeleton`.
Motion assemble(const Body& body, std::vector<Frame> frames, double fps);

}  // namespace mcdbn::synthesis
