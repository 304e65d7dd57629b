#pragma once

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mcdbn/formats/track_file.hpp"

namespace mcdbn::test {

// A body as detectors' files hold it, each joint with a confidence of a half, and what reading a
// file reported.

/// [joints] x and y
using Places = std::vector<std::array<double, 2>>;

/// MediaPipe's: an object for each joint.
inline nlohmann::json landmarks_at(const Places& places) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [x, y] : places) list.push_back({{"x", x}, {"y", y}, {"score", 0.5}});
  return list;
}

/// MMPose's: the joints, and a list of their scores beside them.
inline nlohmann::json instance_at(const Places& places) {
  return {{"keypoints", places}, {"keypoint_scores", std::vector<double>(places.size(), 0.5)}};
}

/// A frame of OpenPose's with one person.
inline nlohmann::json openpose_frame_at(const Places& places) {
  nlohmann::json numbers = nlohmann::json::array();
  for (const auto& [x, y] : places)
    for (const double value : {x, y, 0.5}) numbers.push_back(value);
  nlohmann::json people = nlohmann::json::array();
  people.push_back(nlohmann::json{{"pose_keypoints_2d", numbers}});
  return {{"people", people}};
}

inline bool any_notice(const TrackReading& reading, const std::string& words) {
  return std::ranges::any_of(reading.notices, [&](const std::string& notice) {
    return notice.find(words) != std::string::npos;
  });
}

}  // namespace mcdbn::test
