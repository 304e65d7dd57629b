#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mcdbn/camera/track_frame.hpp"
#include "mcdbn/formats/track_file.hpp"

namespace mcdbn {

/// Reads a 2D track line by line, as it is written: JSON, the value of one frame in each line as
/// any of the JSON formats has it, or our own CSV, whose header line stands before the frames. The
/// first line that is not empty decides which of the two it is. JSON in which nobody is, in any
/// layout, is a frame that shows nobody. What reading a whole file finds from all of it is found
/// here from what has come so far: joints and whether coordinates are shares of the image by the
/// first frame that shows a person, rate and image size by `options` or the file itself. If that
/// frame shows several people, the largest, or the one of the number that is wanted, is followed.
/// Confidences beyond 1 are 1.
class TrackLines {
 public:
  /// @param name of the source, for messages
  /// @throws ConfigError for a person that cannot be chosen so
  explicit TrackLines(std::string name, const TrackReadOptions& options = {});
  ~TrackLines();
  TrackLines(TrackLines&&) noexcept;
  TrackLines& operator=(TrackLines&&) noexcept;

  /// @return the frame that the line holds, none if it holds none (empty, a comment, the header);
  ///         of no joints while no person was seen and the joints are not known
  /// @throws InputError `name:line: what`; the lines that follow can be read all the same
  std::optional<TrackFrame> read(std::string_view line);

  /// Whether joints, rate and image size are known.
  bool knows_joints() const;
  /// Joints, rate and image size, as a track without frames.
  const Track2d& like() const;
  /// What was assumed or left out, each once.
  std::vector<std::string> take_notices();

 private:
  class Reader;
  std::unique_ptr<Reader> reader_;
};

}  // namespace mcdbn
