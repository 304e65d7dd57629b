// OpenCV's own: camera_matrix, distortion_coefficients, image_width, image_height, and the pose as
// rvec or R with tvec. Ours has unit_m, too, where the units of tvec are known.

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <opencv2/core/eigen.hpp>
#include <string_view>

#include "base/lower_extension.hpp"
#include "base/text_file.hpp"
#include "formats/camera_formats.hpp"
#include "formats/camera_parts.hpp"
#include "formats/opencv_storage.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

bool recognises(const CameraSource& source) {
  const auto holds = [&](const char* word) { return source.text.find(word) != std::string::npos; };
  return holds("camera_matrix") || holds("%YAML") || holds("opencv_storage");
}

CameraRig read(const CameraSource& source) {
  const OpencvStorage storage(source);
  Camera camera;
  camera.width_px = pixels_of(storage.number("image_width"), storage.where("image_width"));
  camera.height_px = pixels_of(storage.number("image_height"), storage.where("image_height"));
  set_intrinsics(camera, storage.square("camera_matrix", "[fx 0 cx; 0 fy cy; 0 0 1]"),
                 storage.where("camera_matrix"));
  constexpr const char* kDistortion = "distortion_coefficients";
  const bool fisheye = storage.has("fisheye") && storage.number("fisheye") != 0;
  (fisheye ? set_fisheye : set_distortion)(
      camera, storage.has(kDistortion) ? storage.matrix(kDistortion).values : std::vector<double>{},
      storage.where(kDistortion));
  const std::string rotation = storage.has("rvec") ? "rvec" : "R";
  if (!storage.has(rotation))
    throw InputError(fmt::format("{}:1: neither rvec nor R is there; add the camera's rotation",
                                 source.path.string()));
  const std::vector<double> values = storage.matrix(rotation).values;
  if (rotation == "rvec" && values.size() != 3)
    throw InputError(storage.where(rotation) + " needs 3 numbers; give a rotation vector");
  if (rotation == "R" && values.size() != 9)
    throw InputError(storage.where(rotation) + " is not 3x3; give a rotation matrix");
  set_pose(camera, rotation_of(values, storage.where(rotation)), storage.point("tvec"), WorldUp::y);
  if (storage.has("unit_m")) {
    camera.unit_m = storage.number("unit_m");
    if (!(*camera.unit_m > 0))
      throw InputError(storage.where("unit_m") + " is not above 0; give metres");
  }
  CameraRig rig{{{"camera", camera}}, {}};
  // Only our own files have a unit.
  if (camera.unit_m)
    rig.stated = {"its world is y-up"};
  else
    rig.assumed = {"its world is y-up and in the motion's file units"};
  return rig;
}

}  // namespace

CameraFormat opencv_camera_format() {
  return {"opencv", "OpenCV's FileStorage (YAML, XML, JSON), one camera, world y-up, file units",
          recognises, read};
}

bool has_camera_ending(const std::filesystem::path& path) {
  constexpr std::array<std::string_view, 4> kEndings{".yml", ".yaml", ".xml", ".json"};
  return std::ranges::find(kEndings, lower_extension(path)) != kEndings.end();
}

void write_camera(const std::filesystem::path& path, const Camera& camera) {
  if (!has_camera_ending(path)) {
    throw InputError(
        fmt::format("{}: no camera format has the ending '{}'; use .yml, .xml or .json",
                    path.string(), path.extension().string()));
  }
  std::string text;
  try {
    // In memory the name only chooses the format.
    cv::FileStorage storage("camera" + lower_extension(path),
                            cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
    cv::Mat rotation;
    cv::eigen2cv(camera.camera_from_world, rotation);
    storage << "image_width" << camera.width_px << "image_height" << camera.height_px;
    storage << "camera_matrix"
            << cv::Mat(cv::Matx33d(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0,
                                   0, 1));
    if (!camera.distortion.empty()) {
      storage << "distortion_coefficients" << cv::Mat(camera.distortion);
    }
    if (camera.fisheye) storage << "fisheye" << 1;
    storage << "R" << rotation << "tvec"
            << cv::Mat(cv::Vec3d(camera.translation.x(), camera.translation.y(),
                                 camera.translation.z()));
    if (camera.unit_m) storage << "unit_m" << *camera.unit_m;
    text = storage.releaseAndGetString();
  } catch (const cv::Exception&) {
    throw InputError(fmt::format("{}: OpenCV cannot write this camera", path.string()));
  }
  write_text_file(path, text);
}

}  // namespace mcdbn
