#pragma once

#include <cstdint>

#include "camera/detector_noise.hpp"
#include "mcdbn/camera/camera.hpp"
#include "mcdbn/motion/skeleton_roles.hpp"

namespace mcdbn {

/// Keypoints of a clip as the camera sees them, exactly: confidence 1, NaN and 0 where one is
/// behind the camera, outside of its image, or not on the body.
Track2d project_keypoints(const Motion& motion, const SkeletonRoles& roles,
                          const std::vector<Keypoint>& keypoints, const Camera& camera);

/// What a detector would make of the clip: its joints with its noise, of which there is more where
/// the body is in its own way. The same seed gives the same.
/// @throws ConfigError if a setting is out of range
Track2d detector_track(const Motion& motion, const SkeletonRoles& roles,
                       const std::vector<Keypoint>& keypoints, const Camera& camera,
                       const DetectorNoise& noise, std::uint64_t seed);

}  // namespace mcdbn
