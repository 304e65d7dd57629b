#pragma once

// A body that stands still, as an exact track, and what a detector makes of it.

#include <vector>

#include "camera/detector_noise.hpp"
#include "camera/keypoint_track.hpp"

namespace mcdbn::test::standing_body {

inline constexpr double kHeight_px = 400;

inline const std::vector<Keypoint> kBody = {
    keypoint("nose", JointRole::head, {0, 0, 0.07}),
    keypoint("LHip", JointRole::left_hip),
    keypoint("RHip", JointRole::right_hip),
    keypoint("LKnee", JointRole::left_knee),
    keypoint("RKnee", JointRole::right_knee),
    keypoint("LAnkle", JointRole::left_ankle),
    keypoint("LHeel", JointRole::left_ankle, {0, -0.02, -0.03}),
    keypoint("RHeel", JointRole::right_ankle, {0, -0.02, -0.03}),
    keypoint("RAnkle", JointRole::right_ankle),
    keypoint("LWrist", JointRole::left_wrist),
    keypoint("RWrist", JointRole::right_wrist),
};
inline constexpr int kLeftKnee = 3, kRightKnee = 4, kLeftAnkle = 5, kLeftHeel = 6, kRightHeel = 7,
                     kRightAnkle = 8, kLeftWrist = 9, kRightWrist = 10;

/// A body that stands still, its joints 40 px from each other.
inline Track2d standing(int frames, double fps = 30) {
  Track2d track;
  track.keypoints = kBody;
  track.fps = fps;
  for (const Keypoint& point : kBody) track.joint_names.push_back(point.name);
  const auto joints = static_cast<Eigen::Index>(kBody.size());
  track.x_px = MatrixD::Constant(frames, joints, 500);
  track.y_px = MatrixD::Constant(frames, joints, 300);
  for (Eigen::Index j = 0; j < joints; ++j) track.x_px.col(j).array() += 41.0 * j;
  track.confidence = MatrixD::Ones(frames, joints);
  return track;
}

inline Flags nothing_hidden(const Track2d& track) {
  return Flags::Constant(track.frames(), track.joint_count(), false);
}

inline Eigen::VectorXd heights(const Track2d& track) {
  return Eigen::VectorXd::Constant(track.frames(), kHeight_px);
}

/// Without errors; what has to be above 0 is as usual.
inline DetectorNoise noiseless() {
  DetectorNoise none;
  visit_settings(none, [](const Setting& setting, double& value) {
    if (setting.range.contains(0)) value = 0;
  });
  none.confidence = 1;
  return none;
}

inline Track2d detected(const Track2d& exact, const DetectorNoise& noise, std::uint64_t seed,
                        bool hidden = false) {
  Track2d track = exact;
  detect(track, Flags::Constant(track.frames(), track.joint_count(), hidden), heights(track), noise,
         seed);
  return track;
}

}  // namespace mcdbn::test::standing_body
