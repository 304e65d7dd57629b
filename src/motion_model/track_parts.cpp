#include "motion_model/track_parts.hpp"

#include <algorithm>
#include <cmath>

#include "camera/shown_body.hpp"

namespace mcdbn {
namespace {

constexpr double kPart_s = 300;
constexpr double kShared_s = 2;

/// The frames of a stretch in ranges that do not overlap, none shorter than its margin. Each shows
/// a body, if any does.
/// @param bodies which frames of the track show one
std::vector<FrameRange> divided(const std::vector<bool>& bodies, const FrameRange& stretch,
                                int frames, int margin) {
  std::vector<FrameRange> ranges;
  const auto shows_a_body = [&](const FrameRange& range) {
    const auto first = bodies.begin() + range.first;
    return std::find(first, first + range.frames, true) != first + range.frames;
  };
  const auto merge_last = [&] {
    const FrameRange last = ranges.back();
    ranges.pop_back();
    ranges.back().frames += last.frames;
  };
  for (int first = stretch.first; first < stretch.end(); first += frames) {
    ranges.push_back({first, std::min(frames, stretch.end() - first)});
    if (ranges.size() == 1) continue;
    const FrameRange before = ranges[ranges.size() - 2];
    if (ranges.back().frames <= margin || !shows_a_body(ranges.back()) || !shows_a_body(before))
      merge_last();
  }
  return ranges;
}

}  // namespace

std::vector<TrackPart> parts_of(const Track2d& track, const FrameRange& stretch) {
  const auto frames_of = [&](double seconds) {
    return static_cast<int>(std::min<double>(std::lround(seconds * track.fps), stretch.frames));
  };
  const int margin = frames_of(kShared_s), frames = std::max(1, frames_of(kPart_s));
  std::vector<TrackPart> parts;
  int known = stretch.first;
  for (const FrameRange& own : divided(frames_of_a_body(track), stretch, frames, margin)) {
    const int first = std::max(stretch.first, own.first - margin);
    const int end = std::min(stretch.end(), own.end() + margin);
    parts.push_back({{first, end - first}, known - first});
    known = end;
  }
  return parts;
}

}  // namespace mcdbn
