#include "mcdbn/formats/track_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>

#include "formats/track_formats.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

std::string start_of(const std::filesystem::path& path) {
  constexpr std::size_t kStart = 4096;
  std::ifstream file(path, std::ios::binary);
  std::string start(kStart, '\0');
  if (!file || !(file.read(start.data(), kStart) || file.eof()))
    throw InputError(fmt::format("{}: cannot be read", path.string()));
  start.resize(static_cast<std::size_t>(file.gcount()));
  return start;
}

std::string names() {
  std::vector<std::string> all;
  for (const TrackFormat& format : track_formats()) all.emplace_back(format.name);
  return fmt::format("{}", fmt::join(all, ", "));
}

}  // namespace

const std::vector<TrackFormat>& track_formats() {
  static const std::vector<TrackFormat> formats{track_csv_format()};
  return formats;
}

const TrackFormat* track_format_of(const std::filesystem::path& path) {
  const std::string start = start_of(path);
  const auto found = std::ranges::find_if(
      track_formats(), [&](const TrackFormat& format) { return format.recognises(start); });
  return found == track_formats().end() ? nullptr : &*found;
}

Track2d read_track(const std::filesystem::path& path, const std::string& format) {
  if (format.empty()) {
    const TrackFormat* recognised = track_format_of(path);
    if (recognised == nullptr)
      throw InputError(
          fmt::format("{}: not a 2D track of a known format ({})", path.string(), names()));
    return recognised->read(path);
  }
  const auto named = std::ranges::find_if(
      track_formats(), [&](const TrackFormat& known) { return format == known.name; });
  if (named == track_formats().end())
    throw InputError(fmt::format("no track format is called {}; there are: {}", format, names()));
  return named->read(path);
}

}  // namespace mcdbn
