#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "camera/detector_noise.hpp"
#include "camera/random_camera.hpp"

namespace mcdbn::cli {

/// Whose tracks to imitate: the joints, and what becomes of them.
struct DetectorLike {
  std::vector<Keypoint> keypoints;
  DetectorNoise noise;
};

/// @param said a name of detectors(), or a track file: then its joints, and the noise that it shows
/// @throws InputError if it is neither, or the file's joints are no detector's
DetectorLike detector_like(const std::string& said);

/// "openpose, mediapipe, coco".
std::string detector_names();

/// --detector-elevation-from and the other settings of DetectorCameras.
void add_detector_camera_flags(CLI::App& command, DetectorCameras& cameras);

}  // namespace mcdbn::cli
