#include "motion_model/track_parts.hpp"

#include <algorithm>
#include <cmath>

namespace mcdbn {
namespace {

constexpr double kPart_s = 300;
constexpr double kShared_s = 2;

/// Whether a frame of it shows half of the joints.
bool shows_a_body(const Track2d& track, const FrameRange& range) {
  const auto seen = track.confidence.middleRows(range.first, range.frames).array() > 0;
  return 2 * seen.cast<int>().rowwise().sum().maxCoeff() >= track.joint_count();
}

/// The frames of a stretch in ranges that do not overlap, none shorter than its margin. Each shows
/// a body, if any does.
std::vector<FrameRange> divided(const Track2d& track, const FrameRange& stretch, int frames,
                                int margin) {
  std::vector<FrameRange> ranges;
  const auto merge_last = [&] {
    const FrameRange last = ranges.back();
    ranges.pop_back();
    ranges.back().frames += last.frames;
  };
  for (int first = stretch.first; first < stretch.end(); first += frames) {
    ranges.push_back({first, std::min(frames, stretch.end() - first)});
    if (ranges.size() == 1) continue;
    const FrameRange before = ranges[ranges.size() - 2];
    if (ranges.back().frames <= margin || !shows_a_body(track, ranges.back()) ||
        !shows_a_body(track, before))
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
  for (const FrameRange& own : divided(track, stretch, frames, margin)) {
    const int first = std::max(stretch.first, own.first - margin);
    const int end = std::min(stretch.end(), own.end() + margin);
    parts.push_back({{first, end - first}, known - first});
    known = end;
  }
  return parts;
}

}  // namespace mcdbn
