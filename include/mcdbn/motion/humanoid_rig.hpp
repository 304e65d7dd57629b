#pragma once

#include <array>
#include <vector>

#include "mcdbn/motion/humanoid.hpp"

namespace mcdbn {

/// How a skeleton and the canonical humanoid take each other's motion, from each role's joint to
/// the other's. Orientations are kept in the world: the humanoid's upper arm is turned as the
/// skeleton's, whatever pose either rests in. Where bones are split differently (several joints
/// between spine and chest, or neck and head) the humanoid's one bone points where the whole chain
/// does, and on the way back the joints between share the bend evenly. Joints without a role
/// (fingers, twist bones) and roles without a joint stay as they rest on their parents.
class HumanoidRig {
 public:
  /// @param motion shows how the joints are turned where the rest pose is not a person's
  ///        (docs/joints.md); one without frames has its rest pose alone
  /// @throws InputError if no joint is known to be the pelvis
  HumanoidRig(const Motion& motion, const SkeletonRoles& roles);
  explicit HumanoidRig(const Motion& motion);

  /// The humanoid with this person's bones, in the same file units: is_humanoid. What the skeleton
  /// lacks is as long as in the canonical one of that height.
  const Skeleton& body() const { return body_; }
  const Skeleton& skeleton() const { return skeleton_; }
  /// The roles that were given, except that the spine is the first joint of the trunk that turns.
  const SkeletonRoles& roles() const { return roles_; }

  /// The motion on body(), the pelvis where it is.
  /// @param motion of skeleton()'s joints
  Motion to_humanoid(const Motion& motion) const;
  /// The humanoid's motion on skeleton(), the pelvis where the humanoid's is.
  /// @param humanoid of any lengths, in this skeleton's units
  Motion from_humanoid(const Motion& humanoid) const;

  /// The joints whose motion the humanoid takes: those with a role and those between two.
  std::vector<int> kept_joints() const;

 private:
  /// A bone of the humanoid that is several of the skeleton's. A trunk's share its bend; what
  /// stands between wrist and knuckles goes with these.
  struct Chain {
    int lower = -1, upper = -1;
    bool bends = true;
    std::vector<int> between;
    Eigen::Matrix3d upper_from_lower;  ///< at rest
  };
  const Chain* chain_above(int lower) const;
  void add_chain(JointRole from, JointRole to, bool bends);
  void measure(const std::vector<WorldPose>& poses);
  std::vector<Eigen::Matrix3d> humanoid_turns(const WorldPose& pose) const;
  void turn_chain(const Chain& chain, const Eigen::Vector3d& chord,
                  std::vector<Eigen::Matrix3d>& wanted) const;
  std::vector<Eigen::Matrix3d> wanted_turns(const WorldPose& humanoid) const;

  Skeleton skeleton_, body_;
  SkeletonRoles roles_;
  /// By role; see RigAxes.
  std::array<Eigen::Matrix3d, kJointRoleCount> axes_;
  std::vector<Chain> chains_;
  // At rest, or on average:
  std::vector<Eigen::Matrix3d> parent_from_joint_;  ///< used of joints without a role
  std::vector<Eigen::Vector3d> local_;              ///< where each joint is on its parent
};

/// Joints that a person's skeleton needs on each side; the left ones.
inline constexpr std::array kPersonsLimbs{
    std::array{JointRole::left_hip, JointRole::left_knee, JointRole::left_ankle},
    std::array{JointRole::left_shoulder, JointRole::left_elbow, JointRole::left_wrist}};

/// The rig of a person's motion; the joints' roles follow from their names.
/// @param joint_map roles given by hand, of one skeleton or of several: those of joints that this
///        one has not are left out
/// @throws InputError as the rig does; or naming the joints of a person that the skeleton has not:
///         hips, knees, ankles, shoulders, elbows and wrists of both sides, neck or head
HumanoidRig rig_of_person(const Motion& motion, const JointMap& joint_map = {});

/// Roles that a person moves and that no joint of the skeleton has, so that their motion is lost
/// where the skeleton takes a person's: roles of limbs; the spine where the trunk has no joint.
/// @throws InputError naming what is missing if a whole limb, or neck and head, have no joint
std::vector<JointRole> lost_roles(const SkeletonRoles& roles);

}  // namespace mcdbn
