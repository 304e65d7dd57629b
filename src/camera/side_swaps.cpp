#include "mcdbn/camera/side_swaps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/numbers.hpp"
#include "base/upper_median.hpp"
#include "camera/keypoint_pairs.hpp"
#include "camera/track_columns.hpp"
#include "mcdbn/camera/track_stretches.hpp"

namespace mcdbn {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// When a detector is taken to have exchanged left and right. Chosen on training people (CMU's walks
// and actions, Bandai's; 200 views at 30 Hz). Where legs are swapped for up to a second, 99, 99 and
// 97 % of the frames are found in a track that is exact, off by 0.2 % and by 0.5 % of body height,
// and 99, 99 and 98 % of those found are right; at most 0.06 % of the frames without swaps are
// taken for swapped. OpenPose's own swaps are short and of crossing legs: 95 % of their share of
// the limbs' error is removed.

/// How much less the joints of a limb pair have to jump, all together, for a swap to begin or end,
/// in body heights.
constexpr double kSwitchCost = 0.25;
/// A joint's distance from where its velocity puts it counts up to so many body heights.
constexpr double kMostResidual = 0.1;
/// What a swap costs while it lasts, in body heights: the sides that a clip has for longer are
/// right.
constexpr double kSwappedCost_per_s = 0.15;

using Swapped = std::vector<int>;  ///< 1 where swapped, one a frame

/// One place on both sides, frame by frame; not finite where it is unknown.
struct PlacePair {
  int left = 0, right = 0;  ///< columns
  std::vector<std::array<Eigen::Vector2d, 2>> seen;
};

/// A column's places in body heights; short gaps are bridged by straight lines.
std::vector<Eigen::Vector2d> places(const Track2d& track, int column, double height_px,
                                    int longest_gap) {
  std::vector<Eigen::Vector2d> result;
  int last = -1;
  for (int t = 0; t < track.frames(); ++t) {
    const bool seen = track.confidence(t, column) > 0;
    result.emplace_back(seen ? track.x_px(t, column) / height_px : kNan,
                        seen ? track.y_px(t, column) / height_px : kNan);
    if (!result.back().allFinite()) continue;
    if (last >= 0 && t - last <= longest_gap + 1)
      for (int between = last + 1; between < t; ++between)
        result[between] = result[last] + (result[t] - result[last]) * (between - last) / (t - last);
    last = t;
  }
  return result;
}

std::vector<PlacePair> pairs_of(const Track2d& track, LimbPair limbs, double height_px) {
  const auto longest_gap = static_cast<int>(kLongestFollowedGap_s * track.fps);
  std::vector<PlacePair> pairs;
  const auto columns =
      (limbs == LimbPair::legs ? leg_pairs(track.keypoints) : arm_pairs(track.keypoints)).columns;
  for (const auto& [left_column, right_column] : columns) {
    PlacePair pair{left_column, right_column, {}};
    const auto left = places(track, left_column, height_px, longest_gap);
    const auto right = places(track, right_column, height_px, longest_gap);
    for (std::size_t t = 0; t < left.size(); ++t) pair.seen.push_back({left[t], right[t]});
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

/// The height of the body on the image, estimated from the spread of its joints: on the image they
/// reach over most of the body's height while it stands, so the usual frame counts. Noise is
/// measured by thighs and shanks (person_height_px), which is nearer to the body's height but needs
/// legs; arms are to be put right where only they are seen.
double body_height_px(const Track2d& track) {
  constexpr double kSpreadOfHeight = 0.27;  // RMS distance from their centre, people who walk
  std::vector<double> spreads;
  for (int t = 0; t < track.frames(); ++t) {
    std::vector<Eigen::Vector2d> seen;
    Eigen::Vector2d sum(0, 0);
    for (int joint = 0; joint < track.joint_count(); ++joint) {
      const Eigen::Vector2d place(track.x_px(t, joint), track.y_px(t, joint));
      if (!(track.confidence(t, joint) > 0) || !place.allFinite()) continue;
      seen.push_back(place);
      sum += place;
    }
    if (seen.size() < 3) continue;
    double squares = 0;
    for (const Eigen::Vector2d& place : seen)
      squares += (place - sum / static_cast<double>(seen.size())).squaredNorm();
    spreads.push_back(std::sqrt(squares / static_cast<double>(seen.size())));
  }
  return spreads.empty() ? 0 : upper_median(std::move(spreads)) / kSpreadOfHeight;
}

/// The distance of both places of a pair from motion at constant velocity, given which of the three
/// frames up to `t` are swapped; 0 where one of them is unknown.
double residual(const PlacePair& pair, std::size_t t, const std::array<int, 3>& swapped) {
  double sum = 0;
  for (const int side : {0, 1}) {
    const auto place = [&](std::size_t back) {
      return pair.seen[t - back][side ^ swapped[2 - back]];
    };
    const double off = (place(0) - 2 * place(1) + place(2)).norm();
    if (!std::isfinite(off)) return 0;
    sum += std::min(off, kMostResidual);
  }
  return sum;
}

/// Sum of all pairs' residuals. Where a swap begins or ends, a pair may stay on its sides: a
/// detector may exchange the ankles alone.
double residual(const std::vector<PlacePair>& pairs, std::size_t t,
                const std::array<int, 3>& swapped) {
  const bool switches = swapped[0] != swapped[1] || swapped[1] != swapped[2];
  double sum = 0;
  for (const PlacePair& pair : pairs) {
    const double staying = residual(pair, t, {0, 0, 0});
    sum += switches ? std::min(staying, residual(pair, t, swapped)) : staying;
  }
  return sum;
}

/// The likeliest sequence. A state is what two frames in a row are: 2 · (the one before) + this.
Swapped likeliest(const std::vector<PlacePair>& pairs, double fps) {
  const std::size_t frames = pairs.front().seen.size();
  if (frames < 3) return Swapped(frames, 0);
  const double per_frame = kSwappedCost_per_s / fps;
  const auto cost_of = [&](int before, int now) {
    return (before != now ? kSwitchCost : 0) + per_frame * now;
  };
  std::array<double, 4> cost{};
  for (int state = 0; state < 4; ++state)
    cost[state] = cost_of(state >> 1, state & 1) + per_frame * (state >> 1);
  std::vector<std::array<int, 4>> came_from(frames);  // the frame before the state's two
  for (std::size_t t = 2; t < frames; ++t) {
    std::array<double, 4> next;
    for (int state = 0; state < 4; ++state) {
      const int before = state >> 1, now = state & 1;
      next[state] = kInfinity;
      for (const int first : {0, 1}) {
        const double total = cost[2 * first + before] + residual(pairs, t, {first, before, now}) +
                             cost_of(before, now);
        if (total >= next[state]) continue;
        next[state] = total;
        came_from[t][state] = first;
      }
    }
    cost = next;
  }
  int state = static_cast<int>(std::ranges::min_element(cost) - cost.begin());
  Swapped swapped(frames);
  swapped[frames - 1] = state & 1;
  for (std::size_t t = frames - 1; t >= 1; --t) {
    swapped[t - 1] = state >> 1;
    if (t >= 2) state = 2 * came_from[t][state] + (state >> 1);
  }
  return swapped;
}

/// Whether exchanging the pair in these frames makes it jump less at their ends.
bool belongs(const PlacePair& pair, const SideSwap& swap) {
  const auto is_swapped = [&](int t) { return t >= swap.first_frame && t <= swap.last_frame; };
  double exchanged = 0, left_alone = 0;
  for (const int end : {swap.first_frame, swap.last_frame + 1}) {
    for (int t = std::max(2, end); t < std::min<int>(end + 2, static_cast<int>(pair.seen.size()));
         ++t) {
      const auto frame = static_cast<std::size_t>(t);
      exchanged += residual(pair, frame, {is_swapped(t - 2), is_swapped(t - 1), is_swapped(t)});
      left_alone += residual(pair, frame, {0, 0, 0});
    }
  }
  return exchanged <= left_alone;
}

void add_swaps(const std::vector<PlacePair>& pairs, LimbPair limbs, const Swapped& swapped,
               std::vector<SideSwap>& swaps) {
  const auto frames = static_cast<int>(swapped.size());
  for (int t = 0; t < frames; ++t) {
    if (swapped[t] == 0) continue;
    SideSwap swap{limbs, t, t, {}, {}};
    while (swap.last_frame + 1 < frames && swapped[swap.last_frame + 1] != 0) ++swap.last_frame;
    t = swap.last_frame;
    for (const PlacePair& pair : pairs) {
      if (!belongs(pair, swap)) continue;
      swap.left.push_back(pair.left);
      swap.right.push_back(pair.right);
    }
    if (!swap.left.empty()) swaps.push_back(std::move(swap));
  }
}

}  // namespace

std::vector<SideSwap> find_side_swaps(const Track2d& track) {
  std::vector<SideSwap> swaps;
  const double height_px = body_height_px(track);
  if (track.keypoints.empty() || !(height_px > 0)) return swaps;
  for (const LimbPair limbs : {LimbPair::legs, LimbPair::arms}) {
    const std::vector<PlacePair> pairs = pairs_of(track, limbs, height_px);
    if (pairs.empty()) continue;
    add_swaps(pairs, limbs, likeliest(pairs, track.fps), swaps);
  }
  return swaps;
}

SideSwap moved(SideSwap swap, int frames) {
  swap.first_frame += frames;
  swap.last_frame += frames;
  return swap;
}

void exchange_sides(Track2d& track, const std::vector<SideSwap>& swaps) {
  for (const SideSwap& swap : swaps)
    for (std::size_t k = 0; k < swap.left.size(); ++k)
      for (int t = swap.first_frame; t <= swap.last_frame; ++t)
        exchange_columns(track, t, swap.left[k], swap.right[k]);
}

std::string described(const std::vector<SideSwap>& swaps, const std::vector<long long>& numbers) {
  std::string text;
  std::optional<LimbPair> previous;
  for (const SideSwap& swap : swaps) {
    const char* limbs = swap.limbs == LimbPair::legs ? "legs" : "arms";
    const std::string frames = described(
        std::vector{FrameRange{swap.first_frame, swap.last_frame - swap.first_frame + 1}}, numbers);
    if (!previous)
      text = fmt::format("{} swapped in frames {}", limbs, frames);
    else if (*previous == swap.limbs)
      text += fmt::format(", {}", frames);
    else
      text += fmt::format("; {} in {}", limbs, frames);
    previous = swap.limbs;
  }
  return text;
}

}  // namespace mcdbn
