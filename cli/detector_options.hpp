#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "corpus/detector_view.hpp"

namespace mcdbn::cli {

/// @param name_or_file a name of detectors(), or a track file: then its joints and measured noise
/// @return the joints and their noise; cameras and people by default
/// @throws InputError if it is neither, or the file's joints are no detector's
DetectorViews detector_like(const std::string& name_or_file);

/// "openpose, mediapipe, coco".
std::string detector_names();

/// --detector-elevation-from and the other settings of DetectorCameras.
std::vector<CLI::Option*> add_detector_camera_flags(CLI::App& command, DetectorCameras& cameras);

}  // namespace mcdbn::cli
