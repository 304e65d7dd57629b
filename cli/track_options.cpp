#include "track_options.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <utility>

#include "setting_flags.hpp"

namespace mcdbn::cli {

namespace {
constexpr const char* kGroup = "Track";
}

std::string track_format_names() {
  std::string names;
  for (const TrackFormat& format : track_formats())
    names += fmt::format("{}{}", names.empty() ? "" : ", ", format.name);
  return names;
}

void add_track_options(CLI::App& command, TrackReadOptions& options) {
  command
      .add_option("--format", options.format,
                  fmt::format("Of the track: {} (default: by its content)", track_format_names()))
      ->type_name("NAME")
      ->group(kGroup);
  command
      .add_option("--person", options.person,
                  "Which one: largest, all, or a number, 1 the largest (default: largest)")
      ->type_name("WHO")
      ->group(kGroup);
  command
      .add_option_function<double>(
          "--fps", [&options](double fps) { options.fps = fps; },
          "Frames a second (default: the file's, else 30)")
      ->check(CLI::PositiveNumber)
      ->group(kGroup);
  command
      .add_option_function<std::pair<int, int>>(
          "--image-size",
          [&options](const std::pair<int, int>& size_px) {
            options.image_size = ImageSize{size_px.first, size_px.second};
          },
          "Width and height in pixels (default: the file's, else guessed)")
      ->check(CLI::PositiveNumber)
      ->type_name("WIDTH HEIGHT")
      ->group(kGroup);
}

TrackReading read_tracks_with_notices(const std::filesystem::path& path,
                                      const TrackReadOptions& options) {
  TrackReading reading = read_tracks(path, options);
  for (const std::string& notice : reading.notices)
    spdlog::info("{}: {}", path.string(), with_flags(notice));
  return reading;
}

}  // namespace mcdbn::cli
