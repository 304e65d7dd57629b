#include "camera/keypoint_pairs.hpp"

#include <algorithm>

namespace mcdbn {
namespace {

/// The column on the body's other side: of the opposite role, where this one's mirror image lies.
int opposite(const std::vector<Keypoint>& keypoints, const Keypoint& keypoint) {
  const Eigen::Vector3d mirrored(-keypoint.offset.x(), keypoint.offset.y(), keypoint.offset.z());
  int nearest = -1;
  double least = 0;
  for (std::size_t i = 0; i < keypoints.size(); ++i) {
    if (keypoints[i].role != other_side(*keypoint.role)) continue;
    const double distance = (keypoints[i].offset - mirrored).norm();
    if (nearest >= 0 && distance >= least) continue;
    nearest = static_cast<int>(i);
    least = distance;
  }
  return nearest;
}

LimbPairs pairs_of(const std::vector<Keypoint>& keypoints, const std::vector<JointRole>& left_roles,
                   const std::vector<JointRole>& telling) {
  LimbPairs pairs;
  for (std::size_t i = 0; i < keypoints.size(); ++i) {
    const Keypoint& keypoint = keypoints[i];
    if (!keypoint.role || std::ranges::count(left_roles, *keypoint.role) == 0) continue;
    const int right = opposite(keypoints, keypoint);
    if (right < 0) continue;
    pairs.columns.emplace_back(static_cast<int>(i), right);
    if (std::ranges::count(telling, *keypoint.role) > 0)
      pairs.telling.emplace_back(static_cast<int>(i), right);
  }
  return pairs;
}

using enum JointRole;

}  // namespace

LimbPairs leg_pairs(const std::vector<Keypoint>& keypoints) {
  return pairs_of(keypoints, {left_hip, left_knee, left_ankle, left_toe}, {left_knee, left_ankle});
}

LimbPairs arm_pairs(const std::vector<Keypoint>& keypoints) {
  return pairs_of(keypoints, {left_shoulder, left_elbow, left_wrist, left_hand},
                  {left_elbow, left_wrist});
}

}  // namespace mcdbn
