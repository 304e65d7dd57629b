#include "mcdbn/motion/humanoid.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace mcdbn {
namespace {

using enum JointRole;
using enum Channel;

/// A bone of the middle or of the left; the right is the left's mirror image.
struct Bone {
  JointRole role;
  JointRole parent;
  Eigen::Vector3d offset;                          ///< from the parent, shares of body height
  Eigen::Vector3d tip = Eigen::Vector3d(0, 0, 0);  ///< where it ends in nothing
};

constexpr double kHeight = 170.0;

using AxisOrder = std::array<Channel, 3>;
constexpr AxisOrder kFormerOrder{z_rotation, x_rotation, y_rotation};

/// Axis order of a role of the middle or of the left. The joint turns about the second axis the
/// least: at 90 degrees there the outer two are one axis.
constexpr AxisOrder axis_order(JointRole role) {
  switch (role) {
    case left_shoulder:
    case left_wrist:
    case left_hip:
    case left_toe:
      return {x_rotation, y_rotation, z_rotation};
    case left_knee:
    case left_ankle:
      return {x_rotation, z_rotation, y_rotation};
    case left_clavicle:
    case left_hand:
      return {z_rotation, x_rotation, y_rotation};
    default:  // the trunk, which turns about Y and bends about X, and elbows, which bend about Y
      return {y_rotation, z_rotation, x_rotation};
  }
}

const std::array kBones{
    Bone{pelvis, pelvis, {0, 0, 0}},
    Bone{spine, pelvis, {0, 0.050, 0}},
    Bone{chest, spine, {0, 0.100, 0}},
    Bone{neck, chest, {0, 0.120, 0}},
    Bone{head, neck, {0, 0.070, 0}, {0, 0.090, 0}},
    Bone{left_clavicle, chest, {0.015, 0.098, 0}},
    Bone{left_shoulder, left_clavicle, {0.114, 0, 0}},
    Bone{left_elbow, left_shoulder, {0.186, 0, 0}},
    Bone{left_wrist, left_elbow, {0.146, 0, 0}},
    Bone{left_hand, left_wrist, {0.054, 0, 0}, {0.054, 0, 0}},
    Bone{left_hip, pelvis, {0.050, -0.040, 0}},
    Bone{left_knee, left_hip, {0, -0.245, 0}},
    Bone{left_ankle, left_knee, {0, -0.246, 0}},
    Bone{left_toe, left_ankle, {0, -0.028, 0.073}, {0, 0, 0.041}},
};

/// The joints' order, parents first and depth first, as files have it.
std::vector<JointRole> order() {
  std::vector<JointRole> roles;
  const auto add = [&](JointRole first, JointRole last, bool right) {
    for (const Bone& bone : kBones)
      if (bone.role >= first && bone.role <= last)
        roles.push_back(right ? other_side(bone.role) : bone.role);
  };
  add(pelvis, head, false);
  for (const bool right : {false, true}) add(left_clavicle, left_hand, right);
  for (const bool right : {false, true}) add(left_hip, left_toe, right);
  return roles;
}

std::vector<Channel> channels_of(JointRole role, const AxisOrder& axes) {
  std::vector<Channel> channels;
  if (role == pelvis) channels = {x_position, y_position, z_position};
  channels.insert(channels.end(), axes.begin(), axes.end());
  return channels;
}

Joint joint_of(JointRole role, const SkeletonRoles& roles) {
  const bool right = role > left_toe;
  const Bone& bone = *std::ranges::find(kBones, right ? other_side(role) : role, &Bone::role);
  const Eigen::Vector3d side(right ? -kHeight : kHeight, kHeight, kHeight);
  Joint joint;
  joint.name = name_of(role);
  const JointRole parent = right ? other_side(bone.parent) : bone.parent;
  joint.parent = role == pelvis ? -1 : roles.joint(parent);
  joint.offset = side.cwiseProduct(bone.offset);
  joint.channels = channels_of(role, axis_order(bone.role));
  if (bone.tip.norm() > 0) joint.end_sites = {side.cwiseProduct(bone.tip)};
  return joint;
}

struct Humanoid {
  Skeleton skeleton;
  SkeletonRoles roles;

  Humanoid() {
    for (const JointRole role : order()) {
      roles.set(role, skeleton.joint_count());
      skeleton.joints.push_back(joint_of(role, roles));
    }
  }
};

const Humanoid& humanoid() {
  static const Humanoid built;
  return built;
}

}  // namespace

const Skeleton& canonical_humanoid() {
  return humanoid().skeleton;
}

const SkeletonRoles& humanoid_roles() {
  return humanoid().roles;
}

bool is_humanoid(const Skeleton& skeleton) {
  const Skeleton& humanoid = canonical_humanoid();
  if (skeleton.joint_count() != humanoid.joint_count()) return false;
  for (int j = 0; j < humanoid.joint_count(); ++j) {
    const Joint &joint = skeleton.joints[j], &own = humanoid.joints[j];
    if (joint.name != own.name || joint.parent != own.parent) return false;
    if (joint.channels != own.channels &&
        joint.channels != channels_of(*humanoid_roles().role_of(j), kFormerOrder))
      return false;
  }
  return true;
}

Motion with_humanoid_orders(const Motion& motion) {
  Motion result = motion;
  if (!is_humanoid(motion.skeleton)) return result;
  for (int j = 0; j < motion.skeleton.joint_count(); ++j) {
    const Joint& was = motion.skeleton.joints[j];
    Joint& now = result.skeleton.joints[j];
    now.channels = canonical_humanoid().joints[j].channels;
    if (now.channels == was.channels) continue;
    const int first = motion.skeleton.first_channel(j);
    for (int t = 0; t < motion.frames(); ++t)
      set_local_rotation(now, local_rotation(was, motion.channels.row(t).data() + first),
                         t > 0 ? result.channels.row(t - 1).data() + first : nullptr,
                         result.channels.row(t).data() + first);
  }
  return result;
}

}  // namespace mcdbn
