#include "detector_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/named_errors.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/camera/joint_sets.hpp"
#include "mcdbn/formats/track_file.hpp"
#include "setting_flags.hpp"

namespace mcdbn::cli {

std::string detector_names() {
  std::vector<std::string_view> names;
  for (const Detector& detector : detectors()) names.push_back(detector.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

DetectorViews detector_like(const std::string& name_or_file) {
  const auto named = std::ranges::find(detectors(), name_or_file, &Detector::name);
  if (named != detectors().end())
    return {joint_set(named->joint_set).keypoints, named->noise, {}, {}};
  if (!std::filesystem::exists(name_or_file))
    throw InputError(fmt::format("{}: neither a detector ({}) nor a track file", name_or_file,
                                 detector_names()));
  const Track2d track = read_track(name_or_file);
  const double height_px = person_height_px(track);
  if (track.keypoints.empty() || !std::isfinite(height_px))
    throw InputError(fmt::format(
        "{}: shows no person's hip, knee and ankle as a detector names them; its noise cannot be "
        "measured",
        name_or_file));
  return with_name(name_or_file, [&]() -> DetectorViews {
    return {seen_keypoints(track), measured_noise(track, height_px), {}, {}};
  });
}

std::vector<CLI::Option*> add_detector_camera_flags(CLI::App& command, DetectorCameras& cameras) {
  std::vector<CLI::Option*> flags;
  visit_group("detector", cameras, [&](const Setting& setting, double& value) {
    flags.push_back(add_setting_flag(command, flag_of(setting.name), setting, value)
                        ->group("Cameras drawn around the person, by --seed"));
  });
  return flags;
}

}  // namespace mcdbn::cli
