#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mcdbn/corpus/clip.hpp"

namespace mcdbn {

/// What is odd about clips that are read: what is the same of many is reported once.
class ClipNotices {
 public:
  std::vector<std::string> lines;  ///< of single clips
  /// A leading calibration pose was dropped.
  void add_calibration_pose(const std::filesystem::path& file);
  void add(const ClipNotices& others);
  void append_to(std::vector<std::string>& notices) const;
  std::vector<std::string> all() const;

 private:
  std::size_t posed_ = 0;
  std::filesystem::path first_posed_;
};

/// As load_clip() with a list of notices, for many clips.
Motion load_clip(const std::filesystem::path& path, const ClipOptions& options,
                 ClipNotices& notices);

/// A clip at its own rate. Several threads may call it at once.  @throws InputError as load_clip
LoadedClip load_clip_as_is(const std::filesystem::path& file, bool keep_first_frame,
                           ClipNotices& notices);

}  // namespace mcdbn
