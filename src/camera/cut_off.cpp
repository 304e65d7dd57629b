#include "camera/cut_off.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "mcdbn/motion/humanoid.hpp"

namespace mcdbn {
namespace {

/// A weight below it is unsure: 0.4 of the usual confidence.
constexpr double kSurelySeen = 0.1;
/// As near to the edge is on it, as a share of the image's size.
constexpr double kEdge = 0.01;

using enum JointRole;
constexpr std::array kLimbEnds{left_ankle,  left_toe,  left_wrist,
                               right_ankle, right_toe, right_wrist};

/// The joint before a limb's end, as the humanoid has it; none for other joints.
std::optional<JointRole> joint_before_end(JointRole role) {
  if (std::ranges::find(kLimbEnds, role) == kLimbEnds.end()) return {};
  const SkeletonRoles& roles = humanoid_roles();
  const auto joint = static_cast<std::size_t>(roles.joint(role));
  return roles.role_of(canonical_humanoid().joints[joint].parent);
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
