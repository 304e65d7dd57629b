#pragma once

#include <filesystem>

#include "mcdbn/camera/track.hpp"

namespace mcdbn {

/// CSV with one header line of named columns `joint_x_px, joint_y_px, joint_confidence`; a first
/// column `time_s` gives the rate. Comment lines `# fps=30 width_px=1920 height_px=1080` are
/// written, and read where present. Empty or `nan` cells are missing joints.
/// @throws InputError `file:line: what`
Track2d read_track_csv(const std::filesystem::path& path);
/// Writes atomically.
void write_track_csv(const std::filesystem::path& path, const Track2d& track);

}  // namespace mcdbn
