#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mcdbn/motion/joint_role.hpp"
#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// Roles given by hand: the name of the joint that plays each.
using JointMap = std::map<JointRole, std::string>;

/// Which joint of a skeleton plays which role.
class SkeletonRoles {
 public:
  SkeletonRoles();

  /// The joint's index, or -1 where the skeleton has none for that role.
  int joint(JointRole role) const { return joints_[static_cast<std::size_t>(role)]; }
  bool has(JointRole role) const { return joint(role) >= 0; }
  /// The role that the joint plays, or none.
  std::optional<JointRole> role_of(int joint) const;
  /// Roles that no joint plays, in the order of joint_roles().
  std::vector<JointRole> missing() const;

  void set(JointRole role, int joint) { joints_[static_cast<std::size_t>(role)] = joint; }

 private:
  std::array<int, kJointRoleCount> joints_;
};

/// The roles of a skeleton's joints: those of `given`; then by names, as CMU's files (`LeftUpLeg`,
/// `lfemur`), Bandai, Mixamo, Berkeley MHAD, Xsens, LAFAN, Biped, SMPL, Unreal, Blender and its
/// Rigify, VRM, DAZ, Auto-Rig Pro and others spell them; then, for limbs without known names, by
/// the tree: legs are the longest pair of like chains nearest the root, arms the longest pair
/// above, and the two longest bones in a row are thigh and shank, upper arm and forearm. Left is
/// then found by marks in names, else by the rest pose: up is from legs to arms, forward as the
/// feet point, or along +z; where the rest pose is not a person's, as in a BVH made of ASF, give
/// the sides by hand. A joint that only leads to a limb (CMU's LHipJoint) plays no role.
/// @throws InputError if the skeleton has no joint, or more than one, of a name in `given`, or a
///         joint is given two roles
SkeletonRoles skeleton_roles(const Skeleton& skeleton, const JointMap& given = {});

/// The roles of joints of which nothing is known but their names: the joint's index is the name's.
SkeletonRoles roles_by_name(const std::vector<std::string>& names);

}  // namespace mcdbn
