#pragma once

#include <array>
#include <limits>
#include <utility>

#include "mcdbn/camera/joint_sets.hpp"
#include "mcdbn/camera/track.hpp"
#include "mcdbn/formats/track_file.hpp"

namespace mcdbn::test {

/// Where a role is in a figure that stands upright, shares of its height: to its left and up.
inline Eigen::Vector2d place_in_figure(JointRole role) {
  using R = JointRole;
  constexpr std::array<std::pair<R, std::pair<double, double>>, 12> kPlaces{{
      {R::pelvis, {0, 0.53}},
      {R::spine, {0, 0.6}},
      {R::chest, {0, 0.75}},
      {R::neck, {0, 0.85}},
      {R::head, {0, 0.91}},
      {R::left_shoulder, {0.12, 0.82}},
      {R::left_elbow, {0.16, 0.63}},
      {R::left_wrist, {0.18, 0.485}},
      {R::left_hand, {0.18, 0.43}},
      {R::left_hip, {0.05, 0.53}},
      {R::left_knee, {0.06, 0.285}},
      {R::left_ankle, {0.06, 0.039}},
  }};
  for (const auto& [known, at] : kPlaces) {
    if (known == role) return {at.first, at.second};
    if (other_side(known) == role) return {-at.first, at.second};
  }
  return {role == R::left_toe ? 0.07 : -0.07, 0.01};
}

/// A figure of 400 px that walks to the right by 3 px a frame, seen from the front, of the joints
/// of the format's first set (or of two joints of its own), with one joint missing in frame 1.
inline Track2d figure_track(const TrackFormat& format, int frames = 4) {
  Track2d track;
  if (format.joint_sets.empty()) {
    track.joint_names = {"paw left", "tail"};
  } else {
    track.keypoints = joint_set(format.joint_sets.front()).keypoints;
    for (const Keypoint& keypoint : track.keypoints) track.joint_names.push_back(keypoint.name);
  }
  const auto joints = static_cast<Eigen::Index>(track.joint_names.size());
  track.x_px = track.y_px = MatrixD(frames, joints);
  track.confidence = MatrixD::Constant(frames, joints, 0.75);
  for (Eigen::Index joint = 0; joint < joints; ++joint) {
    Eigen::Vector2d at(0.1 * static_cast<double>(joint), 0.3);
    if (!track.keypoints.empty() && track.keypoints[joint].role)
      at = place_in_figure(*track.keypoints[joint].role) + track.keypoints[joint].offset.head<2>();
    for (int frame = 0; frame < frames; ++frame) {
      track.x_px(frame, joint) = 300 + 1.0 / 3 + 3 * frame + 400 * at.x();
      track.y_px(frame, joint) = 450 - 400 * at.y();
    }
  }
  track.x_px(1, 1) = track.y_px(1, 1) = std::numeric_limits<double>::quiet_NaN();
  track.confidence(1, 1) = 0;
  return track;
}

}  // namespace mcdbn::test
