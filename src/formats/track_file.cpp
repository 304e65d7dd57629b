#include "mcdbn/formats/track_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "formats/joint_naming.hpp"
#include "formats/other_files.hpp"
#include "formats/track_formats.hpp"
#include "formats/track_reading.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

std::string names() {
  std::vector<std::string> all;
  for (const TrackFormat& format : track_formats()) all.push_back(format.name);
  return fmt::format("{}", fmt::join(all, ", "));
}

const TrackFormat* format_of(const TrackSource& source) {
  const auto found = std::ranges::find_if(
      track_formats(), [&](const TrackFormat& format) { return format.recognises(source); });
  return found == track_formats().end() ? nullptr : &*found;
}

const TrackFormat& format_to_read(const TrackSource& source, const std::string& asked) {
  if (!asked.empty()) return track_format(asked);
  if (const TrackFormat* recognised = format_of(source)) return *recognised;
  if (source.is_folder() && source.json_files().empty()) {
    const std::string what = what_else_it_is(source);
    throw InputError(fmt::format("{}: {}", source.name(),
                                 what.empty() ? "no .json files in this folder" : what));
  }
  if (const auto content = source.first_json_if_any(); content && shows_nobody(content->value()))
    throw NoPersonSeen(source.name());
  // For JSON that cannot be parsed the error names the line.
  if (source.is_folder()) source.json_of(source.json_files().front());
  if (const char first = source.first_letter(); first == '{' || first == '[') source.json();
  if (const std::string what = what_else_it_is(source); !what.empty())
    throw InputError(fmt::format("{}: {}", source.name(), what));
  throw InputError(
      fmt::format("{}: not a 2D track of a known format ({})", source.name(), names()));
}

}  // namespace

const std::vector<TrackFormat>& track_formats() {
  static const std::vector<TrackFormat> formats{
      track_csv_format(),       track_openpose_format(), track_alphapose_format(),
      track_coco_format(),      track_mmpose_format(),   track_deeplabcut_format(),
      track_sleap_format(),     track_npy_format(),
      track_mediapipe_format(),  // it knows the most layouts: last
  };
  return formats;
}

const TrackFormat& track_format(const std::string& name) {
  const auto named = std::ranges::find(track_formats(), name, &TrackFormat::name);
  if (named == track_formats().end())
    throw InputError(fmt::format("no track format is called {}; there are: {}", name, names()));
  return *named;
}

const TrackFormat* track_format_of(const std::filesystem::path& path) {
  return format_of(TrackSource(path));
}

TrackReading read_tracks(const std::filesystem::path& path, const TrackReadOptions& options) {
  const TrackSource source(path);
  const TrackFormat& format = format_to_read(source, options.format);
  TrackReading reading = tracks_of(format.read(source), options, source.name());
  reading.format = format.name;
  return reading;
}

Track2d read_track(const std::filesystem::path& path, const TrackReadOptions& options,
                   std::vector<std::string>* notices) {
  TrackReading reading = read_tracks(path, options);
  if (notices != nullptr) *notices = std::move(reading.notices);
  return std::move(reading.people.front());
}

}  // namespace mcdbn
