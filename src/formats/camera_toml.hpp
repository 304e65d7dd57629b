#pragma once

#include <toml++/toml.h>
#include <functional>
#include <optional>
#include <vector>

#include "formats/camera_parts.hpp"
#include "mcdbn/formats/camera_file.hpp"

namespace mcdbn {

/// A camera's section, as Anipose wrote it first and others after it: size, matrix, distortions,
/// rotation, translation.
struct TomlCamera {
  std::string name;
  Camera camera;  ///< without its pose
  Eigen::Matrix3d camera_from_world;
  Eigen::Vector3d translation;
};

/// Whether the text looks like TOML; what does and cannot be parsed is an InputError.
bool is_toml(const CameraSource& source);
/// @throws InputError with file and line
toml::table parse_toml(const CameraSource& source);

/// The sections that are cameras, in the order of the file: tables with a `matrix`, at the top or
/// within a table `cameras`.
struct TomlSection {
  std::string name;
  const toml::table* table;
};
std::vector<TomlSection> camera_sections(const toml::table& file);

/// All cameras of the file. @throws InputError with file, line and camera
std::vector<TomlCamera> toml_cameras(const CameraSource& source);

/// How far the farthest camera is from the world's origin, in the file's units.
double largest_distance(const std::vector<TomlCamera>& cameras);

/// The cameras as a rig in a world that is +y up.
CameraRig rig_of(const std::vector<TomlCamera>& cameras, WorldUp up, double unit_m);
/// The file's cameras, whose world is z-up and in metres. @throws InputError as toml_cameras()
CameraRig rig_z_up_in_metres(const CameraSource& source);

/// What is farther from the world's origin is in millimetres.
inline constexpr double kFarthestCamera_m = 100;

}  // namespace mcdbn
