#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace mcdbn {

/// A joint's part in a human body, whatever its file calls it. A limb's role is the centre of the
/// joint: `left_shoulder` is where the upper arm turns, `left_hip` where the thigh does.
enum class JointRole {
  pelvis,
  spine,
  chest,
  neck,
  head,
  left_clavicle,
  left_shoulder,
  left_elbow,
  left_wrist,
  left_hand,
  left_hip,
  left_knee,
  left_ankle,
  left_toe,
  right_clavicle,
  right_shoulder,
  right_elbow,
  right_wrist,
  right_hand,
  right_hip,
  right_knee,
  right_ankle,
  right_toe,
};

inline constexpr std::size_t kJointRoleCount = static_cast<std::size_t>(JointRole::right_toe) + 1;

/// All roles, in the order of the enumeration.
std::span<const JointRole> joint_roles();

/// The role as files and messages spell it: "left_shoulder".
std::string_view name_of(JointRole role);
/// The role of that spelling, or none.
std::optional<JointRole> joint_role_of(std::string_view name);

/// The role's counterpart on the body's other side; the role itself if it is in the middle.
JointRole other_side(JointRole role);

}  // namespace mcdbn
