#pragma once

#include <cstdint>
#include <vector>

#include "camera/detector_noise.hpp"
#include "camera/random_camera.hpp"
#include "mcdbn/corpus/augmentation.hpp"
#include "motion/other_body.hpp"

namespace mcdbn {

/// Clips as a detector would see them in the field: another person does the same before a camera
/// that stands anywhere.
struct DetectorViews {
  std::vector<Keypoint> keypoints;
  DetectorNoise noise;
  DetectorCameras cameras;
  OtherBody body;
};

/// The clip as a detector would see it in the field. A seed gives the same view for every model.
/// @param motion at the rate that the track is to have
AugmentedView detector_view(const Motion& motion, const DetectorViews& views, std::uint64_t seed);

}  // namespace mcdbn
