#include "mcdbn/corpus/clip.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "base/interruption.hpp"
#include "base/text_file.hpp"
#include "corpus/clip_notices.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/motion_file.hpp"
#include "mcdbn/motion/frame_rate.hpp"
#include "motion/resample.hpp"

namespace fs = std::filesystem;

namespace mcdbn {
namespace {

/// Files print their frame time rounded; rates closer than this are the same one.
constexpr double kSameRate_hz = 0.01;

std::vector<fs::path> clips_below(const fs::path& folder) {
  std::vector<fs::path> clips;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file() && is_motion_file(entry.path())) clips.push_back(entry.path());
  }
  if (clips.empty()) {
    throw InputError(fmt::format(
        "{}: no .bvh or .amc file in this folder; name one that holds some", folder.string()));
  }
  std::ranges::sort(clips);
  return clips;
}

/// A clip that was read, changed as ClipOptions specify.
Motion prepared(Motion motion, const fs::path& path, const ClipOptions& options,
                ClipNotices& notices) {
  if (!options.keep_first_frame && has_leading_calibration_pose(motion)) {
    motion = without_first_frame(motion);
    notices.add_calibration_pose(path);
  }
  if (motion.frames() == 0) {
    throw InputError(fmt::format("{}: has no frame; use a file with motion", path.string()));
  }
  if (!kUsualFrameRate_hz.contains(motion.fps()))
    notices.lines.push_back(
        fmt::format("{}: it has {:.4g} frames a second; correct it if that is not so",
                    path.string(), motion.fps()));
  const bool resampling = options.fps > 0 && std::abs(options.fps - motion.fps()) > kSameRate_hz;
  return resampling ? resample(motion, options.fps) : motion;
}

}  // namespace

void ClipNotices::add_calibration_pose(const fs::path& file) {
  if (posed_++ == 0) first_posed_ = file;
}

void ClipNotices::add(const ClipNotices& others) {
  lines.insert(lines.end(), others.lines.begin(), others.lines.end());
  if (posed_ == 0) first_posed_ = others.first_posed_;
  posed_ += others.posed_;
}

void ClipNotices::append_to(std::vector<std::string>& notices) const {
  notices.insert(notices.end(), lines.begin(), lines.end());
  if (posed_ == 0) return;
  const std::string whose = posed_ == 1 ? first_posed_.string() : fmt::format("{} clips", posed_);
  notices.push_back(fmt::format("{}: dropped the calibration pose of the first frame", whose));
}

std::vector<std::string> ClipNotices::all() const {
  std::vector<std::string> notices;
  append_to(notices);
  return notices;
}

Motion load_clip(const fs::path& path, const ClipOptions& options, ClipNotices& notices) {
  if (options.fps != 0) check_range("`fps`, if not 0,", kFrameRate_hz, options.fps);
  return prepared(read_motion(path, &notices.lines), path, options, notices);
}

Motion load_clip(const fs::path& path, const ClipOptions& options,
                 std::vector<std::string>* notices) {
  ClipNotices found;
  Motion motion = load_clip(path, options, found);
  if (notices) found.append_to(*notices);
  return motion;
}

LoadedClip load_clip_as_is(const fs::path& file, bool keep_first_frame, ClipNotices& notices) {
  const std::string text = read_text_file(file);
  return {identify_clip(file, text),
          prepared(parse_motion(text, file, &notices.lines), file,
                   {.fps = 0, .keep_first_frame = keep_first_frame}, notices)};
}

std::vector<LoadedClip> load_clips(const std::vector<fs::path>& files, bool keep_first_frame,
                                   std::vector<std::string>* notices) {
  std::vector<LoadedClip> clips;
  ClipNotices found;
  for (const fs::path& file : files) {
    check_interruption();
    clips.push_back(load_clip_as_is(file, keep_first_frame, found));
  }
  if (notices) found.append_to(*notices);
  return clips;
}

std::vector<fs::path> find_clips(const std::vector<fs::path>& paths) {
  std::vector<fs::path> clips;
  std::set<fs::path> seen;
  const auto add = [&](const fs::path& clip) {
    if (seen.insert(fs::weakly_canonical(clip)).second) clips.push_back(clip);
  };
  for (const fs::path& path : paths) {
    if (!fs::exists(path)) {
      throw InputError(fmt::format("{}: no such file or folder", path.string()));
    }
    if (fs::is_directory(path)) {
      std::ranges::for_each(clips_below(path), add);
    } else {
      add(path);
    }
  }
  if (clips.empty()) throw InputError("no motion given; name BVH or AMC files or folders of them");
  return clips;
}

}  // namespace mcdbn
