#include "motion_model/live_output.hpp"

#include "motion/interpolated_pose.hpp"

namespace mcdbn {
namespace {

/// Rates are rounded: a frame so little behind a pose is the pose's.
constexpr double kSlack = 1e-6;

}  // namespace

std::vector<LiveFrame> LiveOutput::add(const Skeleton& skeleton, const RowVectorD& pose,
                                       bool seen) {
  if (poses_ == 0) last_pose_ = last_frame_ = pose;
  std::vector<LiveFrame> frames;
  const auto time = static_cast<double>(poses_);
  for (double at; (at = static_cast<double>(frames_) * poses_per_frame_) <= time + kSlack;
       ++frames_) {
    // Between the pose before and this one.
    const double part = std::min(1.0, at - time + 1);
    last_frame_ = interpolated_pose(skeleton, last_pose_, pose, part, last_frame_);
    frames.push_back({last_frame_, seen});
  }
  ++poses_;
  last_pose_ = pose;
  last_seen_ = seen;
  return frames;
}

std::vector<LiveFrame> LiveOutput::finish(long long frames) {
  std::vector<LiveFrame> rest;
  for (; frames_ < frames; ++frames_) rest.push_back({last_frame_, last_seen_});
  return rest;
}

}  // namespace mcdbn
