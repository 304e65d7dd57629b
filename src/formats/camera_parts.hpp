#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "mcdbn/formats/camera_file.hpp"

namespace mcdbn {

/// What a calibration takes for up in its world.
enum class WorldUp { y, z, minus_y };

/// Refuses what would bring parsers down: control characters, and nesting, for which they call
/// themselves: brackets of JSON, YAML and TOML, tags of XML, and YAML's indentation, in which
/// dashes nest, too.
/// @throws InputError
void check_camera_source(const CameraSource& source);

/// "file:line: " of the first line that holds `mark`, of the first line if none does.
std::string place_of(const std::filesystem::path& path, const std::string& text,
                     const std::string& mark);

// All of these throw InputError, with `where` before what is wrong: "file:3: cam_01: matrix".

/// fx, fy, cx, cy. @param matrix [fx 0 cx; 0 fy cy; 0 0 1], px
void set_intrinsics(Camera& camera, const Eigen::Matrix3d& matrix, const std::string& where);

/// @param values k1 k2 p1 p2 …: 0, 4, 5, 8, 12 or 14 numbers
void set_distortion(Camera& camera, std::vector<double> values, const std::string& where);
/// @param values k1 k2 k3 k4, or none
void set_fisheye(Camera& camera, std::vector<double> values, const std::string& where);

/// @param values a whole number of pixels above 0, may be written as a float
int pixels_of(double value, const std::string& where);

/// The image's size of a calibration without one: as if the principal point were its middle.
void guess_size(Camera& camera);

/// @param values 3 numbers of a rotation vector (radians), or 9 of a matrix, row by row
/// @return orthonormal: of a matrix that was rounded the nearest rotation
Eigen::Matrix3d rotation_of(const std::vector<double>& values, const std::string& where);

/// Where the camera is, turned to a world with +y up.
/// @param translation x_camera = camera_from_world·x_world + translation
void set_pose(Camera& camera, const Eigen::Matrix3d& camera_from_world,
              const Eigen::Vector3d& translation, WorldUp up);

}  // namespace mcdbn
