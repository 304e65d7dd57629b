#include "mcdbn/motion/joint_role.hpp"

#include <algorithm>
#include <array>

namespace mcdbn {
namespace {

struct NamedRole {
  JointRole role;
  std::string_view name;
};

constexpr std::array kNames{
    NamedRole{JointRole::pelvis, "pelvis"},
    NamedRole{JointRole::spine, "spine"},
    NamedRole{JointRole::chest, "chest"},
    NamedRole{JointRole::neck, "neck"},
    NamedRole{JointRole::head, "head"},
    NamedRole{JointRole::left_clavicle, "left_clavicle"},
    NamedRole{JointRole::left_shoulder, "left_shoulder"},
    NamedRole{JointRole::left_elbow, "left_elbow"},
    NamedRole{JointRole::left_wrist, "left_wrist"},
    NamedRole{JointRole::left_hand, "left_hand"},
    NamedRole{JointRole::left_hip, "left_hip"},
    NamedRole{JointRole::left_knee, "left_knee"},
    NamedRole{JointRole::left_ankle, "left_ankle"},
    NamedRole{JointRole::left_toe, "left_toe"},
    NamedRole{JointRole::right_clavicle, "right_clavicle"},
    NamedRole{JointRole::right_shoulder, "right_shoulder"},
    NamedRole{JointRole::right_elbow, "right_elbow"},
    NamedRole{JointRole::right_wrist, "right_wrist"},
    NamedRole{JointRole::right_hand, "right_hand"},
    NamedRole{JointRole::right_hip, "right_hip"},
    NamedRole{JointRole::right_knee, "right_knee"},
    NamedRole{JointRole::right_ankle, "right_ankle"},
    NamedRole{JointRole::right_toe, "right_toe"},
};

constexpr std::array<JointRole, kNames.size()> roles_of_names() {
  std::array<JointRole, kNames.size()> roles{};
  for (std::size_t i = 0; i < roles.size(); ++i) roles[i] = kNames[i].role;
  return roles;
}
constexpr std::array kRoles = roles_of_names();

constexpr int kFirstLeft = static_cast<int>(JointRole::left_clavicle);
constexpr int kFirstRight = static_cast<int>(JointRole::right_clavicle);
constexpr int kSide = kFirstRight - kFirstLeft;

}  // namespace

std::span<const JointRole> joint_roles() {
  return kRoles;
}

std::string_view name_of(JointRole role) {
  return kNames[static_cast<std::size_t>(role)].name;
}

std::optional<JointRole> joint_role_of(std::string_view name) {
  const auto found = std::ranges::find(kNames, name, &NamedRole::name);
  if (found == kNames.end()) return {};
  return found->role;
}

JointRole other_side(JointRole role) {
  const int index = static_cast<int>(role);
  if (index < kFirstLeft) return role;
  return static_cast<JointRole>(index < kFirstRight ? index + kSide : index - kSide);
}

}  // namespace mcdbn
