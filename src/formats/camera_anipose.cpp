// Anipose (aniposelib, CameraGroup.dump) and FreeMoCap, which uses it: rotation vectors; the units
// are those of the board that was shown, millimetres as a rule; the file does not give the up
// axis.

#include <algorithm>

#include "formats/camera_formats.hpp"
#include "formats/camera_toml.hpp"

namespace mcdbn {
namespace {

bool recognises(const CameraSource& source) {
  return is_toml(source) && !camera_sections(parse_toml(source)).empty();
}

/// Whether the world is that of a camera, as it is without a board on the floor.
bool is_world(const TomlCamera& camera) {
  constexpr double kSame = 1e-6;
  return camera.translation.norm() < kSame &&
         (camera.camera_from_world - Eigen::Matrix3d::Identity()).norm() < kSame;
}

CameraRig read(const CameraSource& source) {
  const std::vector<TomlCamera> cameras = toml_cameras(source);
  const bool metres = largest_distance(cameras) < kFarthestCamera_m;
  const auto own = std::ranges::find_if(cameras, is_world);
  const bool of_camera = own != cameras.end();
  CameraRig rig = rig_of(cameras, of_camera ? WorldUp::minus_y : WorldUp::z, metres ? 1.0 : 0.001);
  rig.assumed = {std::string("the file does not give the up axis: ") +
                     (of_camera ? "taken to be upwards in the image of " + own->name +
                                      ", whose axes are the world's"
                                : std::string("taken to be z")),
                 std::string("its units are taken to be ") + (metres ? "metres" : "millimetres") +
                     ", by how far the cameras stand"};
  return rig;
}

}  // namespace

CameraFormat anipose_camera_format() {
  return {"anipose",
          "Anipose's and FreeMoCap's TOML, millimetres or metres by the cameras' distance",
          recognises, read};
}

}  // namespace mcdbn
