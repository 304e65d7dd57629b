#include "motion/retarget.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "mcdbn/base/errors.hpp"
#include "motion/body_size.hpp"

namespace mcdbn {
namespace {

using enum JointRole;

/// Bones from one role to the next, of the left side and the middle.
constexpr std::array kBones{
    std::pair{pelvis, neck},
    std::pair{chest, neck},
    std::pair{neck, head},
    std::pair{left_hip, left_knee},
    std::pair{left_knee, left_ankle},
    std::pair{left_ankle, left_toe},
    std::pair{left_clavicle, left_shoulder},
    std::pair{left_shoulder, left_elbow},
    std::pair{left_elbow, left_wrist},
    std::pair{left_wrist, left_hand},
};
constexpr std::array kLimbs{std::pair{left_hip, left_knee}, std::pair{left_knee, left_ankle},
                            std::pair{left_shoulder, left_elbow},
                            std::pair{left_elbow, left_wrist}};

std::vector<Eigen::Vector3d> rest_positions(const Skeleton& skeleton) {
  std::vector<Eigen::Vector3d> positions;
  for (const Joint& joint : skeleton.joints)
    positions.push_back(joint.parent < 0 ? Eigen::Vector3d(0, 0, 0)
                                         : Eigen::Vector3d(positions[joint.parent] + joint.offset));
  return positions;
}

/// A skeleton at rest, by roles.
struct Rest {
  const SkeletonRoles& roles;
  std::vector<Eigen::Vector3d> positions;

  Rest(const Skeleton& skeleton, const SkeletonRoles& skeleton_roles)
      : roles(skeleton_roles), positions(rest_positions(skeleton)) {}

  /// From one role's joint to another's; none where one is missing or both are in one place.
  std::optional<Eigen::Vector3d> bone(JointRole from, JointRole to) const {
    if (!roles.has(from) || !roles.has(to)) return {};
    const Eigen::Vector3d bone = positions[roles.joint(to)] - positions[roles.joint(from)];
    if (!(bone.norm() > 1e-9)) return {};
    return bone;
  }

  /// Left, up and forward, as columns; the world's axes where that cannot be told.
  Eigen::Matrix3d axes() const {
    const auto left = bone(right_hip, left_hip), up = bone(pelvis, neck);
    if (!left || !up || left->cross(*up).norm() < 1e-9) return Eigen::Matrix3d::Identity();
    Eigen::Matrix3d result;
    result.col(0) = left->normalized();
    result.col(2) = left->cross(*up).normalized();
    result.col(1) = result.col(2).cross(result.col(0));
    return result;
  }
};

/// What a role's bone leads to, the first that both skeletons have.
std::optional<JointRole> bone_end(const Rest& a, const Rest& b, JointRole role) {
  for (const auto& [from, to] : kBones)
    for (const auto& [start, end] :
         {std::pair{from, to}, std::pair{other_side(from), other_side(to)}})
      if (start == role && a.bone(start, end) && b.bone(start, end)) return end;
  return {};
}

/// source_from_target of the joint's own axes: what brings the bone of the target at rest onto that
/// of the source at rest.
Eigen::Matrix3d alignment(const Rest& source, const Rest& target, JointRole role) {
  const Eigen::Matrix3d body = source.axes() * target.axes().transpose();
  const auto end = bone_end(source, target, role);
  if (!end) return body;
  return Eigen::Quaterniond::FromTwoVectors(body * *target.bone(role, *end),
                                            *source.bone(role, *end))
             .toRotationMatrix() *
         body;
}

void set_position(const Joint& joint, const Eigen::Vector3d& local, double* channels) {
  for (std::size_t k = 0; k < joint.channels.size(); ++k)
    if (!is_rotation(joint.channels[k])) channels[k] = local[axis_of(joint.channels[k])];
}

bool has_position(const Joint& joint) {
  return std::ranges::any_of(joint.channels, [](Channel channel) { return !is_rotation(channel); });
}

/// Writes one frame after the other.
class Retargeting {
 public:
  Retargeting(const Motion& motion, const SkeletonRoles& roles, const Skeleton& target,
              const SkeletonRoles& target_roles)
      : motion_(motion), roles_(roles), pelvis_(target_roles.joint(pelvis)) {
    const Rest source_rest(motion.skeleton, roles), target_rest(target, target_roles);
    for (int j = 0; j < target.joint_count(); ++j) {
      const auto role = target_roles.role_of(j);
      const bool known = role && roles.has(*role);
      source_joint_.push_back(known ? roles.joint(*role) : -1);
      alignment_.push_back(known ? alignment(source_rest, target_rest, *role)
                                 : Eigen::Matrix3d::Identity().eval());
    }
    // Whatever stands above the pelvis moves with nothing; the first that can move carries it.
    carrier_ = pelvis_;
    while (!has_position(target.joints[carrier_]) && target.joints[carrier_].parent >= 0)
      carrier_ = target.joints[carrier_].parent;
  }

  void write(int t, Motion& result) const {
    const WorldPose pose = forward_kinematics(motion_.skeleton, motion_.channels.row(t));
    const Skeleton& target = result.skeleton;
    std::vector<Eigen::Matrix3d> world_from_joint(target.joints.size());
    for (int j = 0; j < target.joint_count(); ++j) {
      const Joint& joint = target.joints[j];
      const Eigen::Matrix3d parent =
          joint.parent < 0 ? Eigen::Matrix3d::Identity().eval() : world_from_joint[joint.parent];
      const int first = target.first_channel(j);
      double* channels = result.channels.row(t).data() + first;
      set_position(joint, joint.offset, channels);
      const Eigen::Matrix3d wanted =
          source_joint_[j] < 0 ? parent : pose.world_from_joint[source_joint_[j]] * alignment_[j];
      set_local_rotation(joint, parent.transpose() * wanted,
                         t > 0 ? result.channels.row(t - 1).data() + first : nullptr, channels);
      world_from_joint[j] = parent * local_rotation(joint, channels);
    }
    carry(t, pose.position[roles_.joint(pelvis)], result);
  }

 private:
  /// Moves the body so that its pelvis is there.
  void carry(int t, const Eigen::Vector3d& where, Motion& result) const {
    const Joint& joint = result.skeleton.joints[carrier_];
    if (!has_position(joint)) return;
    double* channels = result.channels.row(t).data() + result.skeleton.first_channel(carrier_);
    const WorldPose pose = forward_kinematics(result.skeleton, result.channels.row(t));
    const Eigen::Matrix3d world_from_parent =
        joint.parent < 0 ? Eigen::Matrix3d::Identity().eval() : pose.world_from_joint[joint.parent];
    const Eigen::Vector3d shift = world_from_parent.transpose() * (where - pose.position[pelvis_]);
    set_position(joint, local_position(joint, channels) + shift, channels);
  }

  const Motion& motion_;
  const SkeletonRoles& roles_;
  int pelvis_, carrier_ = 0;
  std::vector<int> source_joint_;           ///< by joint of the target; -1: it rests
  std::vector<Eigen::Matrix3d> alignment_;  ///< source_from_target, likewise
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

Motion retargeted(const Motion& motion, const SkeletonRoles& roles, const Skeleton& target,
                  const SkeletonRoles& target_roles) {
  if (!roles.has(pelvis) || !target_roles.has(pelvis))
    throw InputError(
        "a skeleton whose pelvis nothing tells cannot take another one's motion; name its joints "
        "in a joint map");
  Motion result{target, motion.frame_time_s,
                MatrixD::Zero(motion.frames(), target.channel_count())};
  const Retargeting retargeting(motion, roles, target, target_roles);
  for (int t = 0; t < motion.frames(); ++t) retargeting.write(t, result);
  return result;
}

}  // namespace mcdbn
