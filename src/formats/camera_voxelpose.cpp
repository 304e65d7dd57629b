// VoxelPose's JSON of Shelf and Campus: R from world to camera, T the camera's centre in
// millimetres, k and p the lens, fx fy cx cy; world z up; no image size (mmpose's tests hold both
// files).

#include <fmt/format.h>

#include "formats/camera_formats.hpp"
#include "formats/camera_json.hpp"
#include "formats/camera_parts.hpp"

namespace mcdbn {
namespace {

bool recognises(const CameraSource& source) {
  const nlohmann::json file = camera_json(source);
  return file.is_object() && !file.empty() && file.front().is_object() &&
         file.front().contains("R") && file.front().contains("T") && file.front().contains("fx");
}

Camera camera_of(const nlohmann::json& entry, const std::string& path) {
  const auto number = [&](const char* key) { return json_numbers(entry, key, 1, path)[0]; };
  Camera camera;
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  matrix(0, 0) = number("fx");
  matrix(1, 1) = number("fy");
  matrix(0, 2) = number("cx");
  matrix(1, 2) = number("cy");
  set_intrinsics(camera, matrix, path + ": its focal length");
  const auto k = json_numbers(entry, "k", 3, path), p = json_numbers(entry, "p", 2, path);
  set_distortion(camera, {k[0], k[1], p[0], p[1], k[2]}, path + ".k");
  guess_size(camera);
  const Eigen::Matrix3d rotation = rotation_of(json_numbers(entry, "R", 9, path), path + ".R");
  const Eigen::Vector3d centre(json_numbers(entry, "T", 3, path).data());
  set_pose(camera, rotation, -rotation * centre, WorldUp::z);
  camera.unit_m = 0.001;
  return camera;
}

CameraRig read(const CameraSource& source) {
  const nlohmann::json file = camera_json(source);
  CameraRig rig;
  for (const auto& [name, entry] : file.items())
    rig.cameras.push_back(
        {name, camera_of(entry, fmt::format("{}: {}", source.path.string(), name))});
  rig.assumed = {"its world is z-up and in millimetres",
                 "it has no image size: twice the principal point is taken for it"};
  return rig;
}

}  // namespace

CameraFormat voxelpose_camera_format() {
  return {"voxelpose", "VoxelPose's JSON, world z-up, millimetres", recognises, read};
}

}  // namespace mcdbn
