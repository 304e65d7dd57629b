#include "camera/shown_body.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

namespace mcdbn {
namespace {

using enum JointRole;

constexpr JointRole kLimbJoints[] = {left_hip,   right_hip,   left_knee,     right_knee,
                                     left_ankle, right_ankle, left_shoulder, right_shoulder,
                                     left_elbow, right_elbow, left_wrist,    right_wrist};

/// The columns of each joint of the limbs; without any, each column by itself.
std::vector<std::vector<int>> joint_columns(const Track2d& track) {
  std::map<JointRole, std::vector<int>> by_role;
  for (std::size_t column = 0; column < track.keypoints.size(); ++column)
    if (const auto& role = track.keypoints[column].role)
      if (std::ranges::find(kLimbJoints, *role) != std::end(kLimbJoints))
        by_role[*role].push_back(static_cast<int>(column));
  std::vector<std::vector<int>> joints;
  joints.reserve(by_role.size());
  for (auto& [role, columns] : by_role) joints.push_back(std::move(columns));
  if (joints.empty())
    for (int column = 0; column < track.joint_count(); ++column) joints.push_back({column});
  return joints;
}

}  // namespace

std::vector<bool> frames_of_a_body(const Track2d& track) {
  const auto frames = static_cast<std::size_t>(track.frames());
  std::vector<int> seen(frames, 0);
  int ever = 0;
  for (const std::vector<int>& columns : joint_columns(track)) {
    bool any = false;
    for (std::size_t t = 0; t < frames; ++t) {
      const bool shown = std::ranges::any_of(columns, [&](int column) {
        return track.confidence(static_cast<Eigen::Index>(t), column) > 0;
      });
      any = any || shown;
      seen[t] += shown ? 1 : 0;
    }
    ever += any ? 1 : 0;
  }
  std::vector<bool> bodies(frames);
  for (std::size_t t = 0; t < frames; ++t) bodies[t] = seen[t] > 0 && 2 * seen[t] >= ever;
  return bodies;
}

std::vector<bool> frames_of_feet(const Track2d& track) {
  std::vector<bool> feet(static_cast<std::size_t>(track.frames()));
  for (std::size_t column = 0; column < track.keypoints.size(); ++column) {
    const auto& role = track.keypoints[column].role;
    if (role != left_ankle && role != right_ankle && role != left_toe && role != right_toe)
      continue;
    for (std::size_t t = 0; t < feet.size(); ++t)
      feet[t] = feet[t] || track.confidence(static_cast<Eigen::Index>(t),
                                            static_cast<Eigen::Index>(column)) > 0;
  }
  return feet;
}

bool shows_feet(const Track2d& track) {
  return std::ranges::count(frames_of_feet(track), true) > 0;
}

}  // namespace mcdbn
