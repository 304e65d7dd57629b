#pragma once

#include <optional>
#include <vector>

#include "mcdbn/camera/keypoint.hpp"
#include "mcdbn/motion/skeleton.hpp"
#include "mcdbn/motion/skeleton_roles.hpp"

namespace mcdbn {

/// x to the body's left, y up along its trunk, z forward, as columns. None without hips and a
/// joint above them.
std::optional<Eigen::Matrix3d> trunk_axes(const WorldPose& pose, const SkeletonRoles& roles);

/// No joint turned, each at its offset, the root too.
WorldPose unturned_pose(const Skeleton& skeleton);

/// Where a moving body has the joints of each role. @return [frames x 3·roles] world, in the order
/// of joint_roles(), NaN where the skeleton has none
MatrixD role_positions(const Motion& motion, const SkeletonRoles& roles);

/// Where a moving body has the places that keypoints show: halfway between two joints, or on one,
/// off by the keypoint's offset, which turns with the joint. How a joint is turned in a body that
/// stands upright is read off the rest pose if that stands; else it is taken to be the joint's mean
/// orientation, in the clip, about the trunk's.
/// @return [frames x 3·keypoints] world, NaN where the skeleton lacks the joint
MatrixD keypoint_places(const Motion& motion, const SkeletonRoles& roles,
                        const std::vector<Keypoint>& keypoints);
/// keypoint_places() of unturned_pose(). @return [1 x 3·keypoints]
MatrixD rest_places(const Skeleton& skeleton, const SkeletonRoles& roles,
                    const std::vector<Keypoint>& keypoints);

}  // namespace mcdbn
