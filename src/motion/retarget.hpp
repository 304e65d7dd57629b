#pragma once

#include "mcdbn/motion/humanoid_rig.hpp"

namespace mcdbn {

/// A skeleton with the limbs of a person: `skeleton` as tall as the person's (body_height), thighs,
/// shanks, upper arms and forearms as long as theirs, by roles. In the person's file units.
Skeleton with_limbs_of(const Skeleton& skeleton, const SkeletonRoles& roles, const Skeleton& person,
                       const SkeletonRoles& person_roles);

/// The motion on another skeleton, in the same file units, by way of the humanoid (HumanoidRig).
/// Joints without a role, or whose role `motion` lacks, stay as they rest on their parent.
/// @throws InputError if `motion` has no pelvis
Motion retargeted(const Motion& motion, const SkeletonRoles& roles, const HumanoidRig& target);

}  // namespace mcdbn
