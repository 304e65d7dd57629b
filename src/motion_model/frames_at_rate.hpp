#pragma once

#include <vector>

#include "mcdbn/camera/track.hpp"
#include "mcdbn/camera/track_frame.hpp"

namespace mcdbn {

/// Frames of a growing track at another rate, as resample_track makes them. Only those frames of
/// the track are kept that are still needed.
class FramesAtRate {
 public:
  /// @param like a track of the same joints, rate and image size
  FramesAtRate(const Track2d& like, double target_hz);

  /// The next frame of the track. @throws ShapeError if it has other joints
  void push(const TrackFrame& frame);
  /// The next frames at the target rate, as far as they are known for certain; each is taken once.
  /// @param ended no more will be pushed: the rest is made of what is there
  std::vector<TrackFrame> take(bool ended);

  long long pushed() const { return pushed_; }  ///< frames of the track
  bool same_rate() const { return same_rate_; }

 private:
  bool is_whole(double at, bool ended) const;
  void drop_unneeded(double at);

  bool same_rate_;
  double step_;   ///< frames of the track from one frame at the target rate to the next
  double reach_;  ///< of frame_at, frames of the track
  Track2d kept_;
  long long first_kept_ = 0;  ///< index in the track of the first frame of kept_
  long long pushed_ = 0, taken_ = 0;
};

}  // namespace mcdbn
