#include "motion/rig_axes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "mcdbn/motion/humanoid.hpp"
#include "motion/nearest_rotation.hpp"
#include "motion/rest_pose.hpp"

namespace mcdbn {
namespace {

using enum JointRole;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Where the bone of a role leads; none of those of the trunk's ends.
std::optional<JointRole> aim_of(JointRole role) {
  switch (role) {
    case pelvis:
    case chest:
    case head:
    case left_hand:
    case right_hand:
    case left_toe:
    case right_toe:
      return {};
    default:
      return static_cast<JointRole>(static_cast<int>(role) + 1);
  }
}

Vector3d humanoid_bone(JointRole from, JointRole to) {
  static const WorldPose rest = rest_pose(canonical_humanoid());
  const SkeletonRoles& roles = humanoid_roles();
  return rest.position[roles.joint(to)] - rest.position[roles.joint(from)];
}

/// The role of the joint above in the humanoid.
JointRole above(JointRole role) {
  const int joint = humanoid_roles().joint(role);
  return *humanoid_roles().role_of(std::max(0, canonical_humanoid().joints[joint].parent));
}

/// The joint of the humanoid's order; parents come first.
JointRole role_at(std::size_t joint) {
  return *humanoid_roles().role_of(static_cast<int>(joint));
}

/// Whether the joint's bone follows one that determines how it is turned: a shank the thigh, but no
/// thigh the pelvis.
bool follows_a_bone(JointRole role) {
  switch (role) {
    case left_elbow:
    case left_wrist:
    case left_hand:
    case left_knee:
    case left_ankle:
    case left_toe:
    case right_elbow:
    case right_wrist:
    case right_hand:
    case right_knee:
    case right_ankle:
    case right_toe:
      return true;
    default:
      return false;
  }
}

/// One pose by roles.
class Places {
 public:
  Places(const WorldPose& pose, const SkeletonRoles& roles) : pose_(pose), roles_(roles) {}

  /// From one role's joint to another's; none where one is missing or both are in one place.
  std::optional<Vector3d> bone(JointRole from, JointRole to) const {
    if (!roles_.has(from) || !roles_.has(to)) return {};
    const Vector3d bone = pose_.position[roles_.joint(to)] - pose_.position[roles_.joint(from)];
    if (!(bone.norm() > 1e-9)) return {};
    return bone;
  }

  std::optional<Vector3d> first_bone(
      std::initializer_list<std::pair<JointRole, JointRole>> bones) const {
    for (const auto& [from, to] : bones)
      if (auto found = bone(from, to)) return found;
    return {};
  }

 private:
  const WorldPose& pose_;
  const SkeletonRoles& roles_;
};

/// The rotation that takes `primary` onto `wanted_primary`, and `secondary` as near to
/// `wanted_secondary` as that leaves it; none where they do not span a plane.
std::optional<Matrix3d> turn_of(const Vector3d& primary, const Vector3d& secondary,
                                const Vector3d& wanted_primary, const Vector3d& wanted_secondary) {
  const auto frame = [](const Vector3d& first, const Vector3d& second) {
    Matrix3d axes;
    axes.col(0) = first.normalized();
    axes.col(1) = (second - axes.col(0).dot(second) * axes.col(0)).normalized();
    axes.col(2) = axes.col(0).cross(axes.col(1));
    return axes;
  };
  if (!(wanted_primary.cross(wanted_secondary).norm() > 1e-9 * wanted_primary.norm())) return {};
  return frame(wanted_primary, wanted_secondary) * frame(primary, secondary).transpose();
}

/// rest_from_humanoid of the whole body.
std::optional<Matrix3d> body_turn(const Places& rest) {
  const auto left = rest.bone(right_hip, left_hip);
  const auto up = rest.first_bone({{pelvis, neck}, {pelvis, head}, {pelvis, chest}});
  if (!left || !up) return {};
  return turn_of(Vector3d::UnitX(), Vector3d::UnitY(), *left, *up);
}

/// Whether the legs hang below, head above, and each arm is on its own side.
bool stands_as_a_body(const Places& rest, const Matrix3d& body) {
  const auto along = [&](std::optional<Vector3d> bone, const Vector3d& axis) {
    return !bone || (body * axis).dot(*bone) > 0.5 * bone->norm();
  };
  for (const auto& [hip, knee, ankle] : {std::tuple{left_hip, left_knee, left_ankle},
                                         std::tuple{right_hip, right_knee, right_ankle}})
    if (!along(rest.bone(hip, knee), -Vector3d::UnitY()) ||
        !along(rest.bone(knee, ankle), -Vector3d::UnitY()))
      return false;
  const auto outwards = [&](JointRole shoulder, JointRole elbow, double side) {
    const auto arm = rest.bone(shoulder, elbow);
    return !arm || side * (body * Vector3d::UnitX()).dot(*arm) > -0.5 * arm->norm();
  };
  return along(rest.bone(right_shoulder, left_shoulder), Vector3d::UnitX()) &&
         outwards(left_shoulder, left_elbow, 1) && outwards(right_shoulder, right_elbow, -1) &&
         along(rest.bone(neck, head), Vector3d::UnitY());
}

RigAxes axes_from_rest(const Places& rest, const SkeletonRoles& roles, const Matrix3d& body) {
  RigAxes axes;
  for (std::size_t j = 0; j < kJointRoleCount; ++j) {
    const JointRole role = role_at(j);
    Matrix3d& own = axes.by_role[static_cast<std::size_t>(role)];
    // A foot of legs that rest apart leans as its leg does; a hand of no fingers goes on straight.
    own = follows_a_bone(role) || !roles.has(role) ? axes.of(above(role)) : body;
    const auto aim = aim_of(role);
    if (const auto bone = aim ? rest.bone(role, *aim) : std::nullopt)
      own = Eigen::Quaterniond::FromTwoVectors(own * humanoid_bone(role, *aim), *bone) * own;
  }
  return axes;
}

/// How a body's joints are turned in one frame as far as their positions determine it:
/// world_from_humanoid, by role, and a weight.
class TurnsOfPlaces {
 public:
  explicit TurnsOfPlaces(const Places& places) : places_(places) {
    for (std::size_t j = 0; j < kJointRoleCount; ++j) set(role_at(j));
  }

  const Matrix3d& of(JointRole role) const { return turn_[static_cast<std::size_t>(role)]; }
  double weight(JointRole role) const { return weight_[static_cast<std::size_t>(role)]; }

 private:
  void set(JointRole role) {
    double weight = 1;
    std::optional<Matrix3d> turn = turn_of_role(role, weight);
    // What does not show is as the joint above it.
    const bool first = role == pelvis;
    turn_[static_cast<std::size_t>(role)] = turn    ? *turn
                                            : first ? Matrix3d::Identity().eval()
                                                    : of(above(role));
    weight_[static_cast<std::size_t>(role)] = turn || first ? weight : this->weight(above(role));
  }

  std::optional<Matrix3d> turn_of_role(JointRole role, double& weight) const {
    const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY();
    const auto aim = aim_of(role);
    const auto bone = aim ? places_.bone(role, *aim) : std::nullopt;
    switch (role) {
      case pelvis: {
        const auto left = places_.bone(right_hip, left_hip);
        const auto up = places_.first_bone({{pelvis, spine}, {pelvis, chest}, {pelvis, neck}});
        return left && up ? turn_of(x, y, *left, *up) : std::nullopt;
      }
      case chest: {
        const auto left =
            places_.first_bone({{right_clavicle, left_clavicle}, {right_shoulder, left_shoulder}});
        const auto up = places_.first_bone({{chest, neck}, {spine, chest}, {pelvis, chest}});
        return left && up ? turn_of(x, y, *left, *up) : std::nullopt;
      }
      case spine:
      case neck:
        return bone ? turn_of(y, x, *bone, of(above(role)).col(0)) : std::nullopt;
      case head:
        return turn_of(y, x, y, of(neck).col(0));
      case left_clavicle:
      case right_clavicle:
        return bone ? turn_of(humanoid_bone(role, *aim), y, *bone, of(chest).col(1)) : std::nullopt;
      case left_ankle:
      case right_ankle:
        return bone ? turn_of(humanoid_bone(role, *aim), x, *bone, of(above(role)).col(0))
                    : std::nullopt;
      case left_shoulder:
      case left_hip:
      case right_shoulder:
      case right_hip:
        return hinged(role, role, weight);
      case left_elbow:
      case left_knee:
      case right_elbow:
      case right_knee:
        return hinged(role, above(role), weight);
      default:
        return {};
    }
  }

  /// A limb's first or second bone, by the axis about which the joint between them bends.
  /// @param first role of the first bone
  std::optional<Matrix3d> hinged(JointRole role, JointRole first, double& weight) const {
    const JointRole middle = *aim_of(first), end = *aim_of(middle);
    const auto upper = places_.bone(first, middle), lower = places_.bone(middle, end);
    if (!upper || !lower) return {};
    const Vector3d axis = upper->normalized().cross(lower->normalized());
    weight = axis.norm();
    const bool leg = first == left_hip || first == right_hip;
    // A shank bends back, a forearm of a T-pose forward: about left; about up, or down on the left.
    const Vector3d at_rest = leg                      ? Vector3d(1, 0, 0)
                             : first == left_shoulder ? Vector3d(0, -1, 0)
                                                      : Vector3d(0, 1, 0);
    return turn_of(humanoid_bone(role, *aim_of(role)), at_rest, role == first ? *upper : *lower,
                   axis);
  }

  const Places& places_;
  std::array<Matrix3d, kJointRoleCount> turn_;
  std::array<double, kJointRoleCount> weight_{};
};

/// One of the joint's own axes, either way, within 35 degrees of a direction across `along`.
std::optional<Vector3d> own_axis_near(const Vector3d& direction, const Vector3d& along) {
  constexpr double kNear = 0.819;  // cosine of 35 degrees
  for (int k = 0; k < 6; ++k) {
    const Vector3d own = (k < 3 ? 1.0 : -1.0) * Vector3d::Unit(k % 3);
    const Vector3d level = own - along.dot(own) * along;
    if (level.norm() > kNear && level.normalized().dot(direction.normalized()) > kNear)
      return level.normalized();
  }
  return {};
}

/// Turned so that the bone lies where it does in the joint, or along an axis if that is not known,
/// and about it so that what is across it is along one.
/// @param humanoid_bone of the humanoid  @param bone of the joint, or 0
Matrix3d along_axes(const Matrix3d& joint_from_humanoid, const Vector3d& humanoid_bone,
                    Vector3d bone) {
  const Vector3d guess = joint_from_humanoid * humanoid_bone;
  if (!(bone.norm() > 1e-9)) bone = own_axis_near(guess, {0, 0, 0}).value_or(guess);
  const Matrix3d aimed =
      Eigen::Quaterniond::FromTwoVectors(guess, bone).toRotationMatrix() * joint_from_humanoid;
  const bool sideways = std::abs(humanoid_bone.x()) > std::abs(humanoid_bone.y());
  const Vector3d along = humanoid_bone.normalized(),
                 side = sideways ? Vector3d::UnitY() : Vector3d::UnitX(),
                 across = aimed * (side - along.dot(side) * along);
  const auto own = own_axis_near(across, bone.normalized());
  return own ? (*turn_of(bone, across, bone, *own) * aimed).eval() : aimed;
}

/// Whether the joint goes on as the one above it: a forearm, a shank, hands, toes, the head, if
/// its bone lies in it as that one's does.
bool goes_on(JointRole role, const Matrix3d& above, const Vector3d& humanoid_bone,
             const Vector3d& bone) {
  constexpr double kAligned = 0.996;  // cosine of 5 degrees
  if (role == head) return true;
  return follows_a_bone(role) &&
         (!(bone.norm() > 1e-9) ||
          (above * humanoid_bone).normalized().dot(bone.normalized()) > kAligned);
}

RigAxes axes_from_motion(const Motion& motion, const SkeletonRoles& roles) {
  constexpr int kMostFrames = 400;
  std::array<Matrix3d, kJointRoleCount> sums;
  sums.fill(Matrix3d::Zero());
  std::array<Vector3d, kJointRoleCount> bones;
  bones.fill(Vector3d::Zero());
  for (const int t : spread_frames(motion, kMostFrames)) {
    const WorldPose pose = forward_kinematics(motion.skeleton, motion.channels.row(t));
    const Places places(pose, roles);
    const TurnsOfPlaces turns(places);
    for (const JointRole role : joint_roles()) {
      if (!roles.has(role)) continue;
      const auto r = static_cast<std::size_t>(role);
      const Matrix3d joint_from_world = pose.world_from_joint[roles.joint(role)].transpose();
      sums[r] += turns.weight(role) * joint_from_world * turns.of(role);
      if (const auto aim = aim_of(role))
        if (const auto bone = places.bone(role, *aim)) bones[r] += joint_from_world * *bone;
    }
  }
  RigAxes axes;
  axes.from_rest = false;
  for (std::size_t j = 0; j < kJointRoleCount; ++j) {
    const JointRole role = role_at(j);
    const auto r = static_cast<std::size_t>(role);
    axes.by_role[r] = roles.has(role) ? nearest_rotation(sums[r]) : axes.of(above(role));
    // Hips and shoulders determine the trunk's turn.
    if (!roles.has(role) || role == pelvis || role == chest) continue;
    const auto aim = aim_of(role);
    const Vector3d bone = aim ? humanoid_bone(role, *aim) : humanoid_bone(above(role), role);
    const Matrix3d& parent = axes.of(above(role));
    axes.by_role[r] = goes_on(role, parent, bone, bones[r])
                          ? parent
                          : along_axes(axes.by_role[r], bone, bones[r]);
  }
  return axes;
}

}  // namespace

std::vector<int> spread_frames(const Motion& motion, int most) {
  const int count = std::min(most, motion.frames());
  std::vector<int> frames;
  frames.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i)
    frames.push_back(static_cast<int>(static_cast<long long>(i) * (motion.frames() - 1) /
                                      std::max(1, count - 1)));
  return frames;
}

RigAxes rig_axes(const Motion& motion, const SkeletonRoles& roles) {
  const WorldPose rest = rest_pose(motion.skeleton);
  const Places places(rest, roles);
  const auto body = body_turn(places);
  if (motion.frames() > 0 && !(body && stands_as_a_body(places, *body)))
    return axes_from_motion(motion, roles);
  return axes_from_rest(places, roles, body.value_or(Matrix3d::Identity()));
}

}  // namespace mcdbn
