#include "motion/retarget.hpp"

#include <array>
#include <optional>
#include <utility>

#include "motion/body_size.hpp"
#include "motion/rest_pose.hpp"

namespace mcdbn {
namespace {

using enum JointRole;

constexpr std::array kLimbs{std::pair{left_hip, left_knee}, std::pair{left_knee, left_ankle},
                            std::pair{left_shoulder, left_elbow},
                            std::pair{left_elbow, left_wrist}};

/// A skeleton at rest, by roles.
struct Rest {
  const SkeletonRoles& roles;
  std::vector<Eigen::Vector3d> positions;

  Rest(const Skeleton& skeleton, const SkeletonRoles& skeleton_roles)
      : roles(skeleton_roles), positions(rest_pose(skeleton).position) {}

  /// From one role's joint to another's; none where one is missing or both are in one place.
  std::optional<Eigen::Vector3d> bone(JointRole from, JointRole to) const {
    if (!roles.has(from) || !roles.has(to)) return {};
    const Eigen::Vector3d bone = positions[roles.joint(to)] - positions[roles.joint(from)];
    if (!(bone.norm() > 1e-9)) return {};
    return bone;
  }
};

}  // namespace

Skeleton with_limbs_of(const Skeleton& skeleton, const SkeletonRoles& roles, const Skeleton& person,
                       const SkeletonRoles& person_roles) {
  Skeleton result = skeleton;
  const double scale = body_height(person) / body_height(skeleton);
  for (Joint& joint : result.joints) {
    joint.offset *= scale;
    for (Eigen::Vector3d& site : joint.end_sites) site *= scale;
  }
  const Rest own(result, roles), theirs(person, person_roles);
  for (const auto& [from, to] : kLimbs)
    for (const auto& [start, end] :
         {std::pair{from, to}, std::pair{other_side(from), other_side(to)}}) {
      const auto bone = own.bone(start, end), wanted = theirs.bone(start, end);
      if (!bone || !wanted) continue;
      for (int j = roles.joint(end); j > roles.joint(start); j = result.joints[j].parent)
        result.joints[j].offset *= wanted->norm() / bone->norm();
    }
  return result;
}

Motion retargeted(const Motion& motion, const SkeletonRoles& roles, const HumanoidRig& target) {
  if (is_humanoid(motion.skeleton)) return target.from_humanoid(motion);
  return target.from_humanoid(HumanoidRig(motion, roles).to_humanoid(motion));
}

}  // namespace mcdbn
