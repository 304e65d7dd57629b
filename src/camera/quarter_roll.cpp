#include "camera/quarter_roll.hpp"

#include <array>
#include <cmath>
#include <initializer_list>
#include <vector>

#include "base/numbers.hpp"
#include "camera/track_columns.hpp"

namespace mcdbn {
namespace {

using enum JointRole;

/// The columns that show the joint of a side, or the other's.
std::vector<int> columns_of_both(const Track2d& track, JointRole left) {
  std::vector<int> columns;
  for (std::size_t column = 0; column < track.keypoints.size(); ++column)
    if (const auto& role = track.keypoints[column].role; role == left || role == other_side(left))
      columns.push_back(static_cast<int>(column));
  return columns;
}

/// The mean of those that are seen; NaN if none is.
Eigen::Vector2d mean_place(const Track2d& track, Eigen::Index frame,
                           const std::vector<int>& columns) {
  Eigen::Vector2d sum(0, 0);
  double count = 0;
  for (const int column : columns) {
    const Eigen::Vector2d place = pixel_at(track, frame, column);
    if (!(track.confidence(frame, column) > 0) || !place.allFinite()) continue;
    sum += place;
    ++count;
  }
  return sum / count;
}

/// By how many quarters a camera is turned clockwise, seen from behind, that has up in that
/// direction of its image: 0, 1, 2 or 3.
std::size_t quarters_of(const Eigen::Vector2d& up) {
  const double quarters = std::atan2(-up.x(), -up.y()) / (90 * kRadiansPerDegree);
  return static_cast<std::size_t>((std::lround(quarters) + 4) % 4);
}

}  // namespace

std::optional<int> quarter_roll_deg(const Track2d& track) {
  const std::vector<int> ankles = columns_of_both(track, left_ankle),
                         knees = columns_of_both(track, left_knee),
                         hips = columns_of_both(track, left_hip),
                         shoulders = columns_of_both(track, left_shoulder);
  std::array<int, 4> turned{};  // frames, by quarters
  int judged = 0;
  for (Eigen::Index t = 0; t < track.frames(); ++t) {
    const auto first_seen = [&](const std::vector<int>& columns, const std::vector<int>& others) {
      const Eigen::Vector2d place = mean_place(track, t, columns);
      return place.allFinite() ? place : mean_place(track, t, others);
    };
    const Eigen::Vector2d trunk = mean_place(track, t, shoulders) - mean_place(track, t, hips),
                          whole = first_seen(shoulders, hips) - first_seen(ankles, knees);
    const bool shows_trunk = trunk.norm() > 0, shows_whole = whole.norm() > 0;
    if (!shows_trunk && !shows_whole) continue;
    ++judged;
    const std::size_t by_trunk = quarters_of(shows_trunk ? trunk : whole),
                      by_whole = quarters_of(shows_whole ? whole : trunk);
    if (by_trunk == by_whole) ++turned[by_trunk];
  }
  constexpr std::array kRoll_deg{0, 90, 180, -90};
  for (std::size_t quarters = 1; quarters < turned.size(); ++quarters)
    if (2 * turned[quarters] > judged) return kRoll_deg[quarters];
  return {};
}

}  // namespace mcdbn
