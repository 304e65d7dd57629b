#include "camera/keypoint_pairs.hpp"

#include <algorithm>

namespace mcdbn {
namespace {

/// Whether the two have opposite roles and places that mirror each other.
bool are_mirrored(const Keypoint& left, const Keypoint& right) {
  const Eigen::Vector3d mirror(-1, 1, 1);
  return right.role == other_side(*left.role) &&
         (left.offset.cwiseProduct(mirror) - right.offset).norm() < 1e-6;
}

LimbPairs pairs_of(const std::vector<Keypoint>& keypoints, const std::vector<JointRole>& left_roles,
                   const std::vector<JointRole>& distal) {
  LimbPairs pairs;
  std::vector<bool> taken(keypoints.size(), false);
  for (std::size_t left = 0; left < keypoints.size(); ++left) {
    const auto& role = keypoints[left].role;
    if (!role || std::ranges::count(left_roles, *role) == 0) continue;
    for (std::size_t right = 0; right < keypoints.size(); ++right) {
      if (taken[right] || !are_mirrored(keypoints[left], keypoints[right])) continue;
      taken[right] = true;
      pairs.columns.emplace_back(static_cast<int>(left), static_cast<int>(right));
      if (std::ranges::count(distal, *role) > 0) pairs.distal.push_back(pairs.columns.back());
      break;
    }
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
