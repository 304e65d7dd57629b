#include "motion_model/frames_at_rate.hpp"

#include <algorithm>
#include <cmath>

#include "camera/track_resample.hpp"
#include "motion/resample.hpp"
#include "motion_model/recent_track.hpp"

namespace mcdbn {

FramesAtRate::FramesAtRate(const Track2d& like, double target_hz)
    : same_rate_(is_same_rate(like.fps, target_hz)),
      step_(same_rate_ ? 1 : like.fps / target_hz),
      reach_(same_rate_ ? 0.5 : std::max(1.0, step_)),
      kept_(without_frames(like)) {}

void FramesAtRate::push(const TrackFrame& frame) {
  append(kept_, frame);
  ++pushed_;
}

std::vector<TrackFrame> FramesAtRate::take(bool ended) {
  std::vector<TrackFrame> frames;
  for (double at; is_whole(at = static_cast<double>(taken_) * step_, ended); ++taken_) {
    const Track2d made = frame_at(kept_, at - static_cast<double>(first_kept_), reach_);
    frames.push_back({made.x_px.row(0), made.y_px.row(0), made.confidence.row(0)});
    drop_unneeded(at);
  }
  return frames;
}

/// A frame between two others is whole when all are there that it is a mean of.
bool FramesAtRate::is_whole(double at, bool ended) const {
  const auto last = static_cast<double>(pushed_ - 1);
  return ended || same_rate_ ? at <= last + kSameRate : at + reach_ <= last + 1 + kSameRate;
}

/// @param at time of the frame that was made last, in frames of the track
void FramesAtRate::drop_unneeded(double at) {
  const auto unneeded = std::clamp<Eigen::Index>(
      static_cast<Eigen::Index>(std::floor(at - reach_)) - first_kept_, 0, kept_.x_px.rows());
  drop_first(kept_, unneeded);
  first_kept_ += unneeded;
}

}  // namespace mcdbn
