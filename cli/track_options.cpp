#include "track_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <utility>
#include <vector>

#include "mcdbn/camera/camera.hpp"
#include "mcdbn/motion/frame_rate.hpp"
#include "setting_flags.hpp"

namespace mcdbn::cli {

namespace {
constexpr const char* kTrackGroup = "Track";
}

CLI::Option* add_format_option(CLI::App& command, std::string& format, const std::string& help) {
  std::vector<std::string> names;
  for (const TrackFormat& known : track_formats()) names.push_back(known.name);
  return command
      .add_option("--format", format, fmt::format("{}: {}", help, fmt::join(names, ", ")))
      ->check(CLI::IsMember(names).description(""))
      ->type_name("NAME");
}

void add_track_options(CLI::App& command, TrackReadOptions& options) {
  add_format_option(command, options.format, "Format of the track (default: by its content)")
      ->group(kTrackGroup);
  command
      .add_option(
          "--person", options.person,
          fmt::format("Which person: largest, all, or a number, 1 the largest (default: {})",
                      options.person))
      ->type_name("WHO")
      ->group(kTrackGroup);
  command
      .add_option_function<double>(
          "--fps", [&options](double fps) { options.fps = fps; },
          "Frames a second (default: the file's, else 30)")
      ->check(in_range(kFrameRate_hz))
      ->group(kTrackGroup);
  command
      .add_option_function<std::pair<int, int>>(
          "--image-size",
          [&options](const std::pair<int, int>& size_px) {
            options.image_size = ImageSize{size_px.first, size_px.second};
          },
          "Width and height in pixels (default: the file's, else the camera's, else guessed)")
      ->check(in_range(Camera::kImage_px))
      ->type_name("WIDTH HEIGHT")
      ->group(kTrackGroup);
}

TrackReading read_tracks_with_notices(const std::filesystem::path& path,
                                      const TrackReadOptions& options) {
  TrackReading reading = read_tracks(path, options);
  for (const std::string& notice : reading.notices)
    spdlog::warn("{}: {}", path.string(), with_flags(notice));
  return reading;
}

}  // namespace mcdbn::cli
