#pragma once

#include <string>

#include "mcdbn/formats/camera_file.hpp"

namespace mcdbn::test {

inline Eigen::Vector3d centre_m(const Camera& camera) {
  return -camera.camera_from_world.transpose() * camera.translation * camera.unit_m.value();
}

/// The world's up in the camera's axes.
inline Eigen::Vector3d up_of(const Camera& camera) {
  return camera.camera_from_world.col(1);
}

inline std::string format_of(const std::filesystem::path& path) {
  const CameraFormat* format = camera_format_of(path);
  return format ? std::string(format->name) : "none";
}

}  // namespace mcdbn::test
