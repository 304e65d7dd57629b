#include "mcdbn/camera/track_stretches.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/numbers.hpp"
#include "base/upper_median.hpp"
#include "camera/keypoint_pairs.hpp"
#include "camera/shown_body.hpp"
#include "camera/track_columns.hpp"

namespace mcdbn {
namespace {

constexpr double kMostAtOnce_heights = 0.75;
constexpr double kFastest_heights_s = 7;
constexpr double kShortest_s = 0.3;
constexpr double kLookBack_s = 1;
constexpr std::size_t kFewestJoints = 3;
/// What the size may change by at once and in a second, and how many joints show it. Measured on 21
/// clips of running, jumping, kicks, dances and the like, as OpenPose's joints: from frame to frame
/// at 30 Hz a whole body changed by a factor of 1.17 at most, in 0.1 s by 1.5, in 1 s by 2.8. Of
/// hips and arms alone one frame in 3,500 was beyond these limits, of arms alone three.
constexpr double kMostGrowthAtOnce = 1.5;
constexpr double kFastestGrowth_s = 3;  ///< of the logarithm
constexpr std::size_t kFewestForSize = 8;

/// A body on the image, or a part of one.
struct Observation {
  int frame = 0;
  Eigen::Vector2d middle;
  double size_px = 0;
  bool is_body = false;
  std::vector<Eigen::Vector2d> joints;  ///< one for each of the columns, NaN where not seen
};

/// The observations from `first` to `last` go on from one another.
struct Run {
  Observation first, last;
  bool shows_a_body = false;  ///< any of them
};

std::vector<int> body_columns(const Track2d& track) {
  std::vector<int> columns;
  for (const LimbPairs& limbs : {leg_pairs(track.keypoints), arm_pairs(track.keypoints)})
    for (const auto& [left, right] : limbs.columns) columns.insert(columns.end(), {left, right});
  if (columns.empty())
    for (int column = 0; column < track.joint_count(); ++column) columns.push_back(column);
  return columns;
}

std::vector<Observation> observations(const Track2d& track) {
  const std::vector<int> columns = body_columns(track);
  const std::vector<bool> bodies = frames_of_a_body(track);
  std::vector<Observation> found;
  std::vector<double> sizes;
  for (int t = 0; t < track.frames(); ++t) {
    std::vector<double> x, y;
    std::vector<Eigen::Vector2d> joints(columns.size(), Eigen::Vector2d::Constant(kNan));
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const Eigen::Vector2d place = pixel_at(track, t, columns[i]);
      if (!(track.confidence(t, columns[i]) > 0) || !place.allFinite()) continue;
      joints[i] = place;
      x.push_back(place.x());
      y.push_back(place.y());
    }
    if (x.size() < kFewestJoints) continue;
    const auto [left, right] = std::ranges::minmax(x);
    const auto [top, bottom] = std::ranges::minmax(y);
    sizes.push_back(std::hypot(right - left, bottom - top));
    found.push_back({t,
                     {upper_median(std::move(x)), upper_median(std::move(y))},
                     sizes.back(),
                     bodies[static_cast<std::size_t>(t)],
                     std::move(joints)});
  }
  // Where a frame shows little of a person, or the person crouches, the clip's median size counts.
  const double usual = sizes.empty() ? 0 : upper_median(std::move(sizes));
  for (Observation& one : found) one.size_px = std::max(one.size_px, usual);
  return found;
}

/// The logarithm of how many times further apart than before the joints are that both show: the
/// median over their pairs, which hardly changes as a body turns or crouches. 0 of too few joints.
double growth(const Observation& before, const Observation& after) {
  std::vector<std::size_t> both;
  for (std::size_t i = 0; i < before.joints.size(); ++i)
    if (before.joints[i].allFinite() && after.joints[i].allFinite()) both.push_back(i);
  if (!before.is_body || !after.is_body || both.size() < kFewestForSize) return 0;
  std::vector<double> growths;
  for (std::size_t a = 0; a < both.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) {
      const double was = (before.joints[both[a]] - before.joints[both[b]]).norm(),
                   is = (after.joints[both[a]] - after.joints[both[b]]).norm();
      if (was > 0 && is > 0) growths.push_back(std::log(is / was));
    }
  return growths.empty() ? 0 : upper_median(std::move(growths));
}

bool goes_on(const Observation& before, const Observation& after, double fps) {
  const double heights =
      (after.middle - before.middle).norm() / std::max({before.size_px, after.size_px, 1e-9});
  const double between_s = (after.frame - before.frame) / fps;
  return heights <= kMostAtOnce_heights + kFastest_heights_s * between_s &&
         std::abs(growth(before, after)) <=
             std::log(kMostGrowthAtOnce) + kFastestGrowth_s * between_s;
}

int frames_of(const Run& run) {
  return run.last.frame + 1 - run.first.frame;
}

bool is_stray(const Run& run, double fps) {
  return frames_of(run) < kShortest_s * fps || !run.shows_a_body;
}

/// The runs of the track. One that goes on behind strays stays one run.
std::vector<Run> runs_of(const std::vector<Observation>& observations, double fps,
                         std::vector<FrameRange>& strays) {
  std::vector<Run> runs;
  for (const Observation& one : observations) {
    std::size_t from = runs.size();  // the run is the one before
    while (from > 0 && !goes_on(runs[from - 1].last, one, fps) && is_stray(runs[from - 1], fps) &&
           one.frame - runs[from - 1].first.frame < kLookBack_s * fps)
      --from;
    if (from == 0 || !goes_on(runs[from - 1].last, one, fps)) {
      runs.push_back({one, one, one.is_body});
      continue;
    }
    for (; runs.size() > from; runs.pop_back())
      strays.push_back({runs.back().first.frame, frames_of(runs.back())});
    runs.back().last = one;
    runs.back().shows_a_body = runs.back().shows_a_body || one.is_body;
  }
  return runs;
}

}  // namespace

std::string described(const std::vector<FrameRange>& ranges,
                      const std::vector<long long>& numbers) {
  const auto number = [&](int frame) {
    return numbers.empty() ? frame : numbers.at(static_cast<std::size_t>(frame));
  };
  std::string text;
  for (const FrameRange& range : ranges) {
    if (!text.empty()) text += ", ";
    text += range.frames == 1 ? fmt::format("{}", number(range.first))
                              : fmt::format("{}-{}", number(range.first), number(range.end() - 1));
  }
  return text;
}

std::vector<FrameRange> frames_of_nobody(const Track2d& track) {
  std::vector<FrameRange> ranges;
  for (int t = 0; t < track.frames(); ++t) {
    if ((track.confidence.row(t).array() > 0).any()) continue;
    if (ranges.empty() || ranges.back().end() < t) ranges.push_back({t, 0});
    ++ranges.back().frames;
  }
  return ranges;
}

TrackStretches find_stretches(const Track2d& track) {
  TrackStretches result;
  if (track.frames() == 0) return result;
  const auto stray = [&](const Run& run) { return is_stray(run, track.fps); };
  const std::vector<Run> runs = runs_of(observations(track), track.fps, result.strays);
  std::vector<Run> kept;
  if (std::ranges::all_of(runs, stray)) {
    result.strays.clear();
  } else {
    for (const Run& run : runs) {
      if (stray(run))
        result.strays.push_back({run.first.frame, frames_of(run)});
      else if (!kept.empty() && goes_on(kept.back().last, run.first, track.fps))
        kept.back().last = run.last;
      else
        kept.push_back(run);
    }
  }
  std::ranges::sort(result.strays, {}, &FrameRange::first);
  int first = 0;
  for (std::size_t i = 0; i < std::max<std::size_t>(kept.size(), 1); ++i) {
    const int end = i + 1 < kept.size() ? kept[i + 1].first.frame : track.frames();
    result.stretches.push_back({first, end - first});
    first = end;
  }
  return result;
}

void leave_out(Track2d& track, const std::vector<FrameRange>& frames) {
  for (const FrameRange& range : frames) {
    track.confidence.middleRows(range.first, range.frames).setZero();
    for (MatrixD* values : {&track.x_px, &track.y_px})
      values->middleRows(range.first, range.frames).setConstant(kNan);
  }
}

}  // namespace mcdbn
