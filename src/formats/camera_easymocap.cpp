// EasyMocap: two OpenCV files, intri.yml with K_NAME and dist_NAME, extri.yml with Rot_NAME (R_NAME
// is its rotation vector) and T_NAME; x_camera = Rot·x_world + T, metres, world z up. Newer ones
// have H_NAME and W_NAME. There may be more cameras in the one than in the other.

#include <fmt/format.h>

#include <algorithm>

#include "base/text_file.hpp"
#include "formats/camera_formats.hpp"
#include "formats/camera_parts.hpp"
#include "formats/opencv_storage.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

bool holds_key(const CameraSource& source, const char* start) {
  return source.text.find(std::string("\n") + start) != std::string::npos;
}

bool has_intrinsics(const CameraSource& source) {
  return holds_key(source, "K_");
}

bool has_poses(const CameraSource& source) {
  return holds_key(source, "T_") && (holds_key(source, "Rot_") || holds_key(source, "R_"));
}

bool recognises(const CameraSource& source) {
  return source.text.starts_with("%YAML") && (has_intrinsics(source) || has_poses(source));
}

/// The other file of the pair, beside this one.
CameraSource partner_of(const CameraSource& source, const std::string& from,
                        const std::string& to) {
  std::string name = source.path.filename().string();
  const auto at = name.find(from);
  const auto path = at == name.npos ? source.path.parent_path() / (to + ".yml")
                                    : source.path.parent_path() / name.replace(at, from.size(), to);
  if (!std::filesystem::is_regular_file(path))
    throw InputError(
        fmt::format("{}:1: the other half of this calibration is missing; put {} beside it",
                    source.path.string(), path.filename().string()));
  CameraSource partner{path, read_text_file(path)};
  check_camera_source(partner);
  return partner;
}

bool has_size(const std::string& name, const OpencvStorage& intrinsics) {
  return intrinsics.has("W_" + name) && intrinsics.has("H_" + name);
}

Camera camera_of(const std::string& name, const OpencvStorage& intrinsics,
                 const OpencvStorage& poses) {
  Camera camera;
  const std::string matrix = "K_" + name, lens = "dist_" + name;
  set_intrinsics(camera, intrinsics.square(matrix, "[fx 0 cx; 0 fy cy; 0 0 1]"),
                 intrinsics.where(matrix));
  if (intrinsics.has(lens))
    set_distortion(camera, intrinsics.matrix(lens).values, intrinsics.where(lens));
  if (has_size(name, intrinsics)) {
    camera.width_px = pixels_of(intrinsics.number("W_" + name), intrinsics.where("W_" + name));
    camera.height_px = pixels_of(intrinsics.number("H_" + name), intrinsics.where("H_" + name));
  } else {
    guess_size(camera);
  }
  const std::string rotation = (poses.has("Rot_" + name) ? "Rot_" : "R_") + name;
  set_pose(camera, rotation_of(poses.matrix(rotation).values, poses.where(rotation)),
           poses.point("T_" + name), WorldUp::z);
  camera.unit_m = 1.0;
  return camera;
}

CameraRig read(const CameraSource& source) {
  const bool whole = has_intrinsics(source) && has_poses(source), first = has_intrinsics(source);
  const CameraSource other = whole   ? source
                             : first ? partner_of(source, "intri", "extri")
                                     : partner_of(source, "extri", "intri");
  const OpencvStorage intrinsics(first ? source : other), poses(first ? other : source);
  CameraRig rig;
  for (const std::string& key : intrinsics.keys()) {
    if (!key.starts_with("K_")) continue;
    const std::string name = key.substr(2);
    if (poses.has("T_" + name)) rig.cameras.push_back({name, camera_of(name, intrinsics, poses)});
  }
  rig.assumed = {"its world is z-up and in metres"};
  if (!std::ranges::all_of(rig.cameras, [&](const NamedCamera& camera) {
        return has_size(camera.name, intrinsics);
      }))
    rig.assumed.emplace_back(
        "where it has no image size (W_NAME, H_NAME), twice the principal point is taken for it");
  return rig;
}

}  // namespace

CameraFormat easymocap_camera_format() {
  return {"easymocap", "EasyMocap's intri.yml and extri.yml (give either), world z-up, metres",
          recognises, read};
}

}  // namespace mcdbn
