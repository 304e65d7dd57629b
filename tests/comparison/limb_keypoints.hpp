#pragma once

#include <vector>

#include "mcdbn/camera/keypoint.hpp"
#include "mcdbn/evaluation/limb_error.hpp"
#include "mcdbn/motion/joint_role.hpp"

namespace mcdbn::test {

/// The limbs' joints and the middle of the hips, as COCO has them.
inline std::vector<Keypoint> limb_keypoints() {
  std::vector<Keypoint> keypoints;
  for (const JointRole role : limb_joints()) {
    Keypoint keypoint;
    keypoint.name = name_of(role);
    keypoint.role = role;
    keypoints.push_back(keypoint);
  }
  return keypoints;
}

}  // namespace mcdbn::test
