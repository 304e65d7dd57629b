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
  for (double at; (at = static_cast<double>(frames_) * poses_per_frame_) <= time + kSlack;) {
    // Between the pose before and this one.
    const double part = std::min(1.0, at - time + 1);
    last_frame_ = interpolated_pose(skeleton, last_pose_, pose, part, last_frame_);
    frames.push_back(next_frame(seen));
  }
  ++poses_;
  last_pose_ = pose;
  last_seen_ = seen;
  return frames;
}

std::vector<LiveFrame> LiveOutput::finish(long long frames) {
  std::vector<LiveFrame> rest;
  while (frames_ < frames) rest.push_back(next_frame(last_seen_));
  return rest;
}

LiveFrame LiveOutput::next_frame(bool seen) {
  ++frames_;
  const bool shows_anybody = shows_anybody_.front();
  shows_anybody_.pop_front();
  return {last_frame_, seen && shows_anybody};
}

}  // namespace mcdbn
