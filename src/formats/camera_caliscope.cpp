// caliscope and its forerunner pyxy3d: [cameras.N] or [cam_N], rotation matrices, metres; the world
// is that of a board on the floor, z up.

#include <algorithm>

#include "formats/camera_formats.hpp"
#include "formats/camera_toml.hpp"

namespace mcdbn {
namespace {

bool recognises(const CameraSource& source) {
  if (!is_toml(source)) return false;
  const toml::table file = parse_toml(source);
  return std::ranges::any_of(camera_sections(file), [](const TomlSection& section) {
    const toml::array* rotation = (*section.table)["rotation"].as_array();
    return rotation && !rotation->empty() && rotation->front().is_array();
  });
}

}  // namespace

CameraFormat caliscope_camera_format() {
  return {"caliscope", "caliscope's and pyxy3d's TOML, world z-up, metres", recognises,
          rig_z_up_in_metres};
}

}  // namespace mcdbn
