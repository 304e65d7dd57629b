#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mcdbn/camera/track.hpp"

namespace mcdbn {

class TrackSource;
struct SeenPeople;

/// One format of 2D tracks: a source file of its own, and a line in track_file.cpp.
struct TrackFormat {
  std::string name;   ///< as people give it
  std::string about;  ///< one line
  /// Names of the joint_sets() that its files hold; empty: the file names its joints itself.
  std::vector<std::string> joint_sets;
  /// Whether the content is of this format. @throws InputError if it cannot be read
  bool (*recognises)(const TrackSource& source);
  /// @throws InputError `file:line: what`, of JSON `file: key's path: what`
  SeenPeople (*read)(const TrackSource& source);
  /// Writes atomically, a folder file by file; none: read only.
  /// @throws InputError if the format has no room for these joints
  void (*write)(const std::filesystem::path& path, const Track2d& track) = nullptr;
};

/// All that there are.
const std::vector<TrackFormat>& track_formats();

/// The format of that name. @throws InputError, listing the formats
const TrackFormat& track_format(const std::string& name);

/// The format that recognises the content of a file, or of a folder of files, or none.
/// @throws InputError if it cannot be read
const TrackFormat* track_format_of(const std::filesystem::path& path);

struct ImageSize {
  int width_px = 0, height_px = 0;
  bool operator==(const ImageSize&) const = default;
};

/// How a track file is read, and values that it may lack.
struct TrackReadOptions {
  std::string format = {};                   ///< a name of track_formats(); empty: by content
  std::string person = "largest";            ///< largest, all, or a number: 1 is the largest
  std::optional<double> fps = std::nullopt;  ///< unset: the file's, else 30
  /// Unset: the file's, else the camera's, else guessed from what was seen.
  std::optional<ImageSize> image_size = std::nullopt;
  std::optional<ImageSize> camera_image = std::nullopt;  ///< of the camera's calibration, if known
};

/// The people of a track file, each followed over all frames of it.
struct TrackReading {
  std::string format;                    ///< a name of track_formats()
  std::string joint_set;                 ///< a name of joint_sets(); empty: the file's own joints
  std::vector<long long> frame_numbers;  ///< [frames] the file's own
  int people_seen = 0;                   ///< those who were followed, chosen or not
  std::vector<Track2d> people;           ///< those chosen, the largest first
  /// A joint's coordinates are a list of numbers in a layout that does not say which of them is x;
  /// x is taken to come first.
  bool axes_are_unnamed = false;
  std::vector<std::string> notices;  ///< what was assumed, guessed, left out or scaled
};

/// Reads a file, or a folder with a file for each frame. Joints that were not seen are NaN with
/// confidence 0, and so are all of a person not seen in a frame. Confidences are from 0 to 1: a
/// file's that overshoot (to 1.5) are cut at 1, greater ones divided by the file's 95 % quantile.
/// @throws InputError as the format does; if no format recognises the content; if a frame shows
/// more than 500 people, or a person has more than 600 joints; if no person of that number was seen
TrackReading read_tracks(const std::filesystem::path& path, const TrackReadOptions& options = {});

/// The first person of read_tracks. @param notices if given, collects TrackReading::notices
Track2d read_track(const std::filesystem::path& path, const TrackReadOptions& options = {},
                   std::vector<std::string>* notices = nullptr);

}  // namespace mcdbn
