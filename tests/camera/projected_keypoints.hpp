#pragma once

#include <vector>

#include "camera/detector_track.hpp"
#include "camera/keypoint_places.hpp"

namespace mcdbn::test {

/// Keypoints of a clip as the camera sees them, without a detector's noise.
inline Track2d project_keypoints(const Motion& motion, const SkeletonRoles& roles,
                                 const std::vector<Keypoint>& keypoints, const Camera& camera) {
  return exact_track(keypoint_places(motion, roles, keypoints), keypoints, camera, motion.fps());
}

}  // namespace mcdbn::test
