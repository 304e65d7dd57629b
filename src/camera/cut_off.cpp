#include "camera/cut_off.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace mcdbn {
namespace {

/// A weight below it is unsure: 0.4 of the usual confidence.
constexpr double kSurelySeen = 0.1;
/// As near to the edge is on it, as a share of the image's size.
constexpr double kEdge = 0.01;

/// The joint before a limb's end.
std::optional<JointRole> joint_before_end(JointRole role) {
  using enum JointRole;
  switch (role) {
    case left_ankle:
      return left_knee;
    case right_ankle:
      return right_knee;
    case left_toe:
      return left_ankle;
    case right_toe:
      return right_ankle;
    case left_wrist:
      return left_elbow;
    case right_wrist:
      return right_elbow;
    default:
      return std::nullopt;
  }
}

bool on_edge(double place_px, int size_px) {
  const double from_edge_px = std::min(std::abs(place_px), std::abs(size_px - place_px));
  return from_edge_px <= kEdge * size_px;
}

}  // namespace

Track2d without_cut_off(Track2d track) {
  if (track.keypoints.empty()) return track;
  const auto columns = static_cast<std::size_t>(track.joint_count());
  for (Eigen::Index t = 0; t < track.frames(); ++t) {
    const auto unsure_on_edge = [&](std::size_t column) {
      const auto k = static_cast<Eigen::Index>(column);
      return track.confidence(t, k) > 0 && track.confidence(t, k) < kSurelySeen &&
             (on_edge(track.x_px(t, k), track.width_px) ||
              on_edge(track.y_px(t, k), track.height_px));
    };
    std::vector<bool> cut(columns);
    for (std::size_t k = 0; k < columns; ++k) cut[k] = unsure_on_edge(k);
    const auto is_seen = [&](JointRole role) {
      for (std::size_t k = 0; k < columns; ++k)
        if (track.keypoints[k].role == role && !cut[k] &&
            track.confidence(t, static_cast<Eigen::Index>(k)) > 0)
          return true;
      return false;
    };
    for (std::size_t k = 0; k < columns; ++k) {
      if (!cut[k]) continue;
      const auto& role = track.keypoints[k].role;
      const auto before = role ? joint_before_end(*role) : std::nullopt;
      if (!before || !is_seen(*before)) track.confidence(t, static_cast<Eigen::Index>(k)) = 0;
    }
  }
  return track;
}

}  // namespace mcdbn
