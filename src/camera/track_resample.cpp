#include "camera/track_resample.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "motion/resample.hpp"

namespace mcdbn {
namespace {

/// The joint at source time `at` (frames): weighted mean over the frames closer than `reach`.
void resample_joint(const Track2d& track, Eigen::Index joint, double at, double reach,
                    Track2d& result, Eigen::Index frame) {
  double weight_sum = 0, x = 0, y = 0, confidence = 0;
  const auto first = std::max<Eigen::Index>(0, static_cast<Eigen::Index>(std::ceil(at - reach)));
  const auto last =
      std::min<Eigen::Index>(track.frames() - 1, static_cast<Eigen::Index>(std::floor(at + reach)));
  for (Eigen::Index t = first; t <= last; ++t) {
    const double weight = 1.0 - std::abs(static_cast<double>(t) - at) / reach;
    if (weight <= 0 || std::isnan(track.x_px(t, joint))) continue;
    weight_sum += weight;
    x += weight * track.x_px(t, joint);
    y += weight * track.y_px(t, joint);
    confidence += weight * track.confidence(t, joint);
  }
  const bool seen = weight_sum > 0;
  constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
  result.x_px(frame, joint) = seen ? x / weight_sum : kMissing;
  result.y_px(frame, joint) = seen ? y / weight_sum : kMissing;
  result.confidence(frame, joint) = seen ? confidence / weight_sum : 0.0;
}

}  // namespace

Track2d frame_at(const Track2d& track, double at, double reach) {
  Track2d frame = track;
  for (MatrixD* values : {&frame.x_px, &frame.y_px, &frame.confidence})
    values->resize(1, track.joint_count());
  for (Eigen::Index joint = 0; joint < track.joint_count(); ++joint)
    resample_joint(track, joint, at, reach, frame, 0);
  return frame;
}

Track2d resample_track(const Track2d& track, double target_hz) {
  const Eigen::Index frames = frames_at_rate(track.frames(), track.fps, target_hz, 0, kSameRate);
  if (is_same_rate(track.fps, target_hz) || track.frames() == 0) return track;
  const double step = track.fps / target_hz;
  Track2d result = track;
  result.fps = target_hz;
  for (MatrixD* values : {&result.x_px, &result.y_px, &result.confidence})
    values->resize(frames, track.joint_count());
  for (Eigen::Index t = 0; t < frames; ++t)
    for (Eigen::Index joint = 0; joint < track.joint_count(); ++joint)
      resample_joint(track, joint, static_cast<double>(t) * step, std::max(1.0, step), result, t);
  return result;
}

}  // namespace mcdbn
