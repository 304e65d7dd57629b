#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "mcdbn/camera/track.hpp"

namespace mcdbn {

/// One format of 2D tracks: a source file of its own, and a line in track_file.cpp.
struct TrackFormat {
  const char* name;   ///< as people give it
  const char* about;  ///< one line
  /// Whether a file that begins with this text is of this format. @param start its first 4 KB
  bool (*recognises)(std::string_view start);
  /// @throws InputError `file:line: what`
  Track2d (*read)(const std::filesystem::path& path);
  /// Writes atomically; none: read only.
  void (*write)(const std::filesystem::path& path, const Track2d& track);
};

/// All that there are.
const std::vector<TrackFormat>& track_formats();

/// The format that recognises the file's content, or none. @throws InputError if it cannot be read
const TrackFormat* track_format_of(const std::filesystem::path& path);

/// @param format a name of track_formats(); empty: recognised by content
/// @throws InputError, listing the formats if none recognises the file
Track2d read_track(const std::filesystem::path& path, const std::string& format = {});

}  // namespace mcdbn
