#include "camera_options.hpp"

#include <utility>

#include "mcdbn/formats/camera_file.hpp"
#include "setting_flags.hpp"

namespace mcdbn::cli {

namespace {
constexpr const char* kGroup = "Camera";
}

Camera CameraOptions::camera_for(const Motion& motion) const {
  return file.empty() ? place_camera(motion, placement) : read_camera(file);
}

void add_camera_options(CLI::App& command, CameraOptions& options) {
  CameraPlacement& placement = options.placement;
  auto* file = command.add_option("--camera", options.file, "OpenCV YAML or XML camera file")
                   ->type_name("FILE")
                   ->group(kGroup);
  const auto placed = [&](CLI::Option* option) { option->group(kGroup)->excludes(file); };
  visit_group("camera", placement, [&](const Setting& setting, double& value) {
    placed(add_setting_flag(command, flag_of(setting.name), setting, value));
  });
  placed(command
             .add_option("--camera-distance", placement.distance,
                         "In the file's units (default: the whole clip just fits in view)")
             ->check(CLI::PositiveNumber));
  placed(command
             .add_option_function<std::pair<int, int>>(
                 "--image-size",
                 [&placement](const std::pair<int, int>& size_px) {
                   std::tie(placement.width_px, placement.height_px) = size_px;
                 },
                 "Width and height in pixels (default: 1920 1080)")
             ->check(CLI::PositiveNumber)
             ->type_name("WIDTH HEIGHT"));
}

void add_view_flags(CLI::App& command, std::optional<double>& azimuth_deg,
                    std::optional<double>& elevation_deg) {
  const CameraPlacement usual;
  visit_group("camera", usual, [&](Setting setting, const double& value) {
    setting.help += "; default: as trained";
    const std::string flag = flag_of(setting.name);
    if (&value == &usual.azimuth_deg) add_setting_flag(command, flag, setting, azimuth_deg);
    if (&value == &usual.elevation_deg) add_setting_flag(command, flag, setting, elevation_deg);
  });
}

}  // namespace mcdbn::cli
