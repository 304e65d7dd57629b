// Berkeley MHAD's cameras as one JSON: clusters with a pose in the world, and in each cameras with
// a pose in it; cluster = R·world + t, camera = rotation(rel_rotvec)·cluster + rel_t, millimetres,
// world y up, images of 640 x 480 pixels.

#include <fmt/format.h>

#include "formats/camera_formats.hpp"
#include "formats/camera_json.hpp"
#include "formats/camera_parts.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

bool recognises(const CameraSource& source) {
  const nlohmann::json file = camera_json(source);
  return file.is_object() && file.contains("clusters") && file["clusters"].is_object();
}

NamedCamera camera_of(const std::string& name, const nlohmann::json& entry,
                      const nlohmann::json& cluster, const std::string& file) {
  const auto dot = name.find('.');
  const std::string of_cluster = fmt::format("{}: clusters.{}", file, name.substr(0, dot)),
                    own = fmt::format("{}.cameras.{}", of_cluster, name.substr(dot + 1));
  Camera camera;
  camera.width_px = 640;
  camera.height_px = 480;
  const auto matrix = json_numbers(entry, "K", 9, own);
  set_intrinsics(camera,
                 Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(matrix.data()),
                 own + ".K");
  set_distortion(camera, json_numbers(entry, "dist_k1k2p1p2", 4, own), own + ".dist_k1k2p1p2");
  const Eigen::Matrix3d cluster_from_world =
                            rotation_of(json_numbers(cluster, "R_world_to_cluster", 9, of_cluster),
                                        of_cluster + ".R_world_to_cluster"),
                        camera_from_cluster = rotation_of(
                            json_numbers(entry, "rel_rotvec_rad", 3, own), own + ".rel_rotvec_rad");
  const Eigen::Vector3d place(json_numbers(cluster, "t_mm", 3, of_cluster).data()),
      shift(json_numbers(entry, "rel_t_mm", 3, own).data());
  set_pose(camera, camera_from_cluster * cluster_from_world, camera_from_cluster * place + shift,
           WorldUp::y);
  camera.unit_m = 0.001;
  return {name, camera};
}

CameraRig read(const CameraSource& source) {
  const nlohmann::json file = camera_json(source);
  CameraRig rig;
  for (const auto& [cluster_name, cluster] : file["clusters"].items()) {
    if (!cluster.is_object() || !cluster.contains("cameras") || !cluster["cameras"].is_object())
      throw InputError(fmt::format("{}: clusters.{}.cameras: is missing; add it",
                                   source.path.string(), cluster_name));
    for (const auto& [name, entry] : cluster["cameras"].items())
      rig.cameras.push_back(
          camera_of(cluster_name + "." + name, entry, cluster, source.path.string()));
  }
  rig.assumed = {"its world is y-up and in millimetres, its images have 640 x 480 pixels"};
  return rig;
}

}  // namespace

CameraFormat mhad_camera_format() {
  return {"mhad", "Berkeley MHAD's calibration as JSON, world y-up, millimetres", recognises, read};
}

}  // namespace mcdbn
