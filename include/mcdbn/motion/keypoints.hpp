#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mcdbn/matrix_types.hpp"

namespace mcdbn {

/// 2D joints over time as one camera sees them. A missing joint is NaN with confidence 0.
struct Track2d {
  std::vector<std::string> joint_names;
  MatrixD x_px, y_px, confidence;  ///< each [frames x joints]
  double fps = 30.0;
  int width_px = 1920, height_px = 1080;

  int frames() const { return static_cast<int>(x_px.rows()); }
  int joint_count() const { return static_cast<int>(joint_names.size()); }
  int find(const std::string& name) const;
};

/// CSV with one header line of named columns `joint_x_px, joint_y_px, joint_confidence`; a first
/// column `time_s` gives the rate. Comment lines `# fps=30 width_px=1920 height_px=1080` are
/// written, and read where present. Empty or `nan` cells are missing joints.
/// @throws InputError `file:line: what`
Track2d read_track_csv(const std::filesystem::path& path);
/// Writes atomically.
void write_track_csv(const std::filesystem::path& path, const Track2d& track);

}  // namespace mcdbn
