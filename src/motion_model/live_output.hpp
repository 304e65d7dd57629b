#pragma once

#include <cmath>
#include <vector>

#include "mcdbn/motion_model/live_regeneration.hpp"
#include "motion/resample.hpp"

namespace mcdbn {

/// Poses at the model's rate become frames at the track's, as they come.
class LiveOutput {
 public:
  LiveOutput(double pose_hz, double frame_hz)
      : poses_per_frame_(std::abs(pose_hz / frame_hz - 1) < kSameRate ? 1 : pose_hz / frame_hz) {}

  /// The next pose. @param skeleton of its channels  @return the frames up to it
  std::vector<LiveFrame> add(const Skeleton& skeleton, const RowVectorD& pose, bool seen);
  /// @param frames of the whole track  @return those that are still to come, in the last pose
  std::vector<LiveFrame> finish(long long frames);

 private:
  double poses_per_frame_;
  long long poses_ = 0, frames_ = 0;
  RowVectorD last_pose_, last_frame_;
  bool last_seen_ = true;
};

}  // namespace mcdbn
