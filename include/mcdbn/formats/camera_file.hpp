#pragma once

#include <filesystem>

#include "mcdbn/camera/camera.hpp"

namespace mcdbn {

/// Reads an OpenCV YAML/XML file: camera_matrix, distortion_coefficients, image_width,
/// image_height, and the pose as rvec or R (rotation matrix) with tvec.
/// @throws InputError
Camera read_camera(const std::filesystem::path& path);
void write_camera(const std::filesystem::path& path, const Camera& camera);

}  // namespace mcdbn
