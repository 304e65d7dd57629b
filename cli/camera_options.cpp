#include "camera_options.hpp"
#include "mcdbn/formats/camera_file.hpp"

#include <utility>

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
  placed(command
             .add_option("--camera-azimuth", placement.azimuth_deg,
                         "Degrees to the figure's left (+x) of a camera that faces it (+z)")
             ->capture_default_str());
  placed(command.add_option("--camera-elevation", placement.elevation_deg, "Degrees upwards")
             ->check(CLI::Range(-89.0, 89.0))
             ->capture_default_str());
  placed(command
             .add_option("--camera-distance", placement.distance,
                         "In the file's units (default: the whole clip just fits in view)")
             ->check(CLI::PositiveNumber));
  placed(command
             .add_option("--camera-fov", placement.field_of_view_deg,
                         "Vertical field of view in degrees")
             ->check(CLI::Range(1.0, 170.0))
             ->capture_default_str());
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

}  // namespace mcdbn::cli
