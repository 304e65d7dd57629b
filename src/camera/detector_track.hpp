#pragma once

#include <cstdint>

#include "camera/detector_noise.hpp"
#include "mcdbn/camera/camera.hpp"
#include "mcdbn/motion/skeleton_roles.hpp"

namespace mcdbn {

/// Keypoints as the camera sees them, exactly: confidence 1; NaN and confidence 0 where one is
/// behind the camera, outside of its image, or not on the body.
/// @param places [frames x 3·keypoints] in the world, as keypoint_places() has them
Track2d exact_track(const MatrixD& places, const std::vector<Keypoint>& keypoints,
                    const Camera& camera, double fps);

/// Track that a detector would make of the clip: its joints with its noise, with more noise where
/// the body occludes itself. A seed always gives the same track.
/// @throws ConfigError if a setting is out of range
Track2d detector_track(const Motion& motion, const SkeletonRoles& roles,
                       const std::vector<Keypoint>& keypoints, const Camera& camera,
                       const DetectorNoise& noise, std::uint64_t seed);

}  // namespace mcdbn
