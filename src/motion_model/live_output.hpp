#pragma once

#include <deque>
#include <vector>

#include "mcdbn/motion_model/live_regeneration.hpp"
#include "motion/resample.hpp"

namespace mcdbn {

/// Turns poses at the model's rate into frames at the track's, as they come.
class LiveOutput {
 public:
  LiveOutput(double pose_hz, double frame_hz)
      : poses_per_frame_(is_same_rate(pose_hz, frame_hz) ? 1 : pose_hz / frame_hz) {}

  /// One frame more has to be returned. @param shows_anybody whether the track's frame does
  void expect(bool shows_anybody) { shows_anybody_.push_back(shows_anybody); }
  /// The next pose. @param skeleton of its channels
  /// @param seen whether it was found in the track: LiveFrame::seen, where the track shows anybody
  /// @return the frames up to it, none but those that are expected
  std::vector<LiveFrame> add(const Skeleton& skeleton, const RowVectorD& pose, bool seen);
  /// @param frames of the whole track  @return those that are still to come, in the last pose
  std::vector<LiveFrame> finish(long long frames);

 private:
  LiveFrame next_frame(bool seen);

  double poses_per_frame_;
  long long poses_ = 0, frames_ = 0;
  RowVectorD last_pose_, last_frame_;
  bool last_seen_ = true;
  std::deque<bool> shows_anybody_;  ///< of the frames that are expected
};

}  // namespace mcdbn
