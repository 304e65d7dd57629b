#include "camera_options.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <utility>
#include <vector>

#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/camera_file.hpp"
#include "setting_flags.hpp"

namespace mcdbn::cli {

namespace {
constexpr const char* kCameraGroup = "Camera";
}

Camera CameraOptions::camera_for(const Motion& motion) const {
  return file.empty() ? place_camera(motion, placement)
                      : in_file_units(read_camera_with_notices(file), motion.skeleton);
}

Camera read_camera_with_notices(const std::filesystem::path& file) {
  std::vector<std::string> assumed, stated;
  Camera camera = read_camera(file, &assumed, &stated);
  if (camera.unit_m)
    stated.push_back(fmt::format(
        "{}: its units of {:g} m are scaled to the motion's, whose body is taken as 1.7 m",
        file.string(), *camera.unit_m));
  for (const std::string& line : assumed) spdlog::warn("{}", line);
  for (const std::string& line : stated) spdlog::info("{}", line);
  return camera;
}

Camera camera_of_track(const Camera& camera, const Track2d& track, const std::string& name) {
  constexpr const char* kSetIt = "set the track's with --image-size if it is not that";
  std::vector<std::string> notices;
  try {
    Camera own = of_scaled_images(camera, track.width_px, track.height_px, &notices);
    for (const std::string& notice : notices) spdlog::warn("{}: {}; {}", name, notice, kSetIt);
    return own;
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}; {}", name, error.what(), kSetIt));
  }
}

std::optional<Camera> SeenByOptions::camera() const {
  if (file.empty()) return std::nullopt;
  return read_camera_with_notices(file);
}

void add_seen_by_options(CLI::App& command, SeenByOptions& options) {
  auto* file = command
                   .add_option("--camera", options.file,
                               "Calibration of the camera that filmed the track, or, with --to "
                               "track, of the one that is to see the motion; one of a file's "
                               "cameras as FILE:NAME (default: unknown, see the options below; "
                               "with --to track: the model's view)")
                   ->type_name("FILE[:NAME]")
                   ->group(kCameraGroup);
  const auto add = [&](const std::string& flag, const Setting& setting,
                       std::optional<double>& value) {
    add_setting_flag(command, flag, setting, value)->group(kCameraGroup)->excludes(file);
  };
  add("--camera-pitch",
      {"pitch", AssumedView::kPitch_deg, "degrees",
       "how far a camera without calibration looks down; default: found from feet on level ground, "
       "where the model can, else level"},
      options.view.pitch_deg);
  add("--camera-roll",
      {"roll", AssumedView::kRoll_deg, "degrees",
       "how far that camera is turned clockwise, seen from behind; default: likewise"},
      options.view.roll_deg);
  add("--camera-fov",
      {"fov", CameraPlacement::kFieldOfView_deg, "degrees",
       "that camera's vertical field of view; default: 60 across the image's longer side"},
      options.view.field_of_view_deg);
}

void add_camera_options(CLI::App& command, CameraOptions& options) {
  CameraPlacement& placement = options.placement;
  auto* file =
      command
          .add_option("--camera", options.file, "Calibration; one of a file's cameras as FILE:NAME")
          ->type_name("FILE[:NAME]")
          ->group(kCameraGroup);
  const auto placed = [&](CLI::Option* option) { option->group(kCameraGroup)->excludes(file); };
  visit_group("camera", placement, [&](const Setting& setting, double& value) {
    placed(add_setting_flag(command, flag_of(setting.name), setting, value));
  });
  placed(command
             .add_option("--camera-distance", placement.distance,
                         "In the file's units (default: the whole clip just fits in view)")
             ->check(in_range(above(0))));
  placed(command
             .add_option_function<std::pair<int, int>>(
                 "--image-size",
                 [&placement](const std::pair<int, int>& size_px) {
                   std::tie(placement.width_px, placement.height_px) = size_px;
                 },
                 "Width and height in pixels (default: 1920 1080)")
             ->check(in_range(Camera::kImage_px))
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
