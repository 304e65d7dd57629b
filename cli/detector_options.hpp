#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "corpus/detector_view.hpp"

namespace mcdbn::cli {

/// @param said a name of detectors(), or a track file: then its joints, and the noise that it shows
/// @return the joints and what becomes of them; cameras and people as usual
/// @throws InputError if it is neither, or the file's joints are no detector's
DetectorViews detector_like(const std::string& said);

/// "openpose, mediapipe, coco".
std::string detector_names();

/// --detector-elevation-from and the other settings of DetectorCameras.
void add_detector_camera_flags(CLI::App& command, DetectorCameras& cameras);

}  // namespace mcdbn::cli
