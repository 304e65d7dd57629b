#include "camera/keypoint_places.hpp"

#include <Eigen/Geometry>
#include <limits>
#include <optional>
#include <vector>

#include "motion/body_size.hpp"
#include "motion/nearest_rotation.hpp"

namespace mcdbn {
namespace {

using enum JointRole;

/// The trunk's axes in the rest pose, if that stands: thighs and shanks below the hips.
std::optional<Eigen::Matrix3d> standing_axes(const WorldPose& rest, const SkeletonRoles& roles) {
  constexpr double kSteep = 0.7;
  const std::optional<Eigen::Matrix3d> axes = trunk_axes(rest, roles);
  if (!axes || !roles.has(left_ankle)) return {};
  const Eigen::Vector3d leg = rest.position[static_cast<std::size_t>(roles.joint(left_ankle))] -
                              rest.position[static_cast<std::size_t>(roles.joint(left_hip))];
  return -leg.normalized().dot(axes->col(1)) > kSteep ? axes : std::nullopt;
}

/// For each joint what turns offsets in upright axes into the joint's own.
std::vector<Eigen::Matrix3d> joint_from_upright(const Motion& motion, const SkeletonRoles& roles,
                                                const std::vector<WorldPose>& poses) {
  const auto joints = motion.skeleton.joints.size();
  const WorldPose rest = unturned_pose(motion.skeleton);
  if (const auto axes = standing_axes(rest, roles)) {
    std::vector<Eigen::Matrix3d> turns;
    for (const Eigen::Matrix3d& joint : rest.world_from_joint)
      turns.emplace_back(joint.transpose() * *axes);
    return turns;
  }
  std::vector<Eigen::Matrix3d> turns(joints, Eigen::Matrix3d::Zero());
  for (const WorldPose& pose : poses)
    if (const auto axes = trunk_axes(pose, roles))
      for (std::size_t j = 0; j < joints; ++j)
        turns[j] += pose.world_from_joint[j].transpose() * *axes;
  for (Eigen::Matrix3d& turn : turns) turn = nearest_rotation(turn);
  return turns;
}

std::vector<WorldPose> poses_of(const Motion& motion) {
  std::vector<WorldPose> poses;
  for (Eigen::Index t = 0; t < motion.frames(); ++t)
    poses.push_back(forward_kinematics(motion.skeleton, motion.channels.row(t)));
  return poses;
}

/// The channels of the rest pose, in one frame.
RowVectorD rest_channels(const Skeleton& skeleton) {
  RowVectorD channels = RowVectorD::Zero(skeleton.channel_count());
  for (int j = 0; j < skeleton.joint_count(); ++j) {
    const Joint& joint = skeleton.joints[static_cast<std::size_t>(j)];
    for (std::size_t k = 0; k < joint.channels.size(); ++k)
      if (!is_rotation(joint.channels[k]))
        channels[skeleton.first_channel(j) + static_cast<int>(k)] =
            joint.offset[axis_of(joint.channels[k])];
  }
  return channels;
}

}  // namespace

std::optional<Eigen::Matrix3d> trunk_axes(const WorldPose& pose, const SkeletonRoles& roles) {
  const auto at = [&](JointRole role) -> const Eigen::Vector3d& {
    return pose.position[static_cast<std::size_t>(roles.joint(role))];
  };
  if (!roles.has(left_hip) || !roles.has(right_hip)) return {};
  const Eigen::Vector3d hips = (at(left_hip) + at(right_hip)) / 2;
  for (const JointRole top : {neck, chest, head, spine}) {
    if (!roles.has(top)) continue;
    const Eigen::Vector3d left = (at(left_hip) - at(right_hip)).normalized(),
                          forward = left.cross(at(top) - hips).normalized();
    Eigen::Matrix3d axes;
    axes << left, forward.cross(left), forward;
    if (axes.allFinite() && axes.determinant() > 0.5) return axes;
  }
  return {};
}

WorldPose unturned_pose(const Skeleton& skeleton) {
  return forward_kinematics(skeleton, rest_channels(skeleton));
}

MatrixD rest_places(const Skeleton& skeleton, const SkeletonRoles& roles,
                    const std::vector<Keypoint>& keypoints) {
  return keypoint_places({skeleton, 1, rest_channels(skeleton)}, roles, keypoints);
}

MatrixD role_positions(const Motion& motion, const SkeletonRoles& roles) {
  MatrixD positions =
      MatrixD::Constant(motion.frames(), 3 * static_cast<Eigen::Index>(joint_roles().size()),
                        std::numeric_limits<double>::quiet_NaN());
  const MatrixD joints = joint_positions(motion);
  for (const JointRole role : joint_roles())
    if (roles.has(role))
      positions.middleCols<3>(3 * static_cast<Eigen::Index>(role)) =
          joints.middleCols<3>(3 * roles.joint(role));
  return positions;
}

MatrixD keypoint_places(const Motion& motion, const SkeletonRoles& roles,
                        const std::vector<Keypoint>& keypoints) {
  MatrixD places =
      MatrixD::Constant(motion.frames(), 3 * static_cast<Eigen::Index>(keypoints.size()),
                        std::numeric_limits<double>::quiet_NaN());
  const std::vector<WorldPose> poses = poses_of(motion);
  const std::vector<Eigen::Matrix3d> turns = joint_from_upright(motion, roles, poses);
  const double height = body_height(motion.skeleton);
  for (std::size_t i = 0; i < keypoints.size(); ++i) {
    const Keypoint& keypoint = keypoints[i];
    const auto& halfway = keypoint.halfway;
    const bool between = halfway && roles.has(halfway->first) && roles.has(halfway->second);
    if (!between && (!keypoint.role || !roles.has(*keypoint.role))) continue;
    for (std::size_t t = 0; t < poses.size(); ++t) {
      const auto at = [&](JointRole role) -> Eigen::Vector3d {
        return poses[t].position[static_cast<std::size_t>(roles.joint(role))];
      };
      Eigen::Vector3d place;
      if (between) {
        place = (at(halfway->first) + at(halfway->second)) / 2;
      } else {
        const auto joint = static_cast<std::size_t>(roles.joint(*keypoint.role));
        place = poses[t].position[joint] +
                poses[t].world_from_joint[joint] * turns[joint] * (height * keypoint.offset);
      }
      places.block<1, 3>(static_cast<Eigen::Index>(t), 3 * static_cast<Eigen::Index>(i)) = place;
    }
  }
  return places;
}

}  // namespace mcdbn
