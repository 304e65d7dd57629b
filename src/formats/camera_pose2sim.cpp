// Pose2Sim and Sports2D: Anipose's sections with four distortions and a key `fisheye`; rotation
// vectors, metres, world z up (Pose2Sim's calibration.py).

#include <algorithm>

#include "formats/camera_formats.hpp"
#include "formats/camera_toml.hpp"

namespace mcdbn {
namespace {

bool recognises(const CameraSource& source) {
  if (!is_toml(source)) return false;
  const toml::table file = parse_toml(source);
  const auto sections = camera_sections(file);
  return !sections.empty() && std::ranges::all_of(sections, [](const TomlSection& section) {
    const toml::array* distortions = (*section.table)["distortions"].as_array();
    const toml::array* translation = (*section.table)["translation"].as_array();
    const auto near = [](const toml::node& at) {
      return std::abs(at.value_or(0.0)) < kFarthestCamera_m;
    };
    return section.table->contains("fisheye") && distortions && distortions->size() == 4 &&
           (!translation || std::all_of(translation->begin(), translation->end(), near));
  });
}

}  // namespace

CameraFormat pose2sim_camera_format() {
  return {"pose2sim", "Pose2Sim's and Sports2D's TOML, world z-up, metres", recognises,
          rig_z_up_in_metres};
}

}  // namespace mcdbn
