#pragma once

#include <vector>

#include "mcdbn/camera/track.hpp"

namespace mcdbn {

/// How well a track shows its person.
struct TrackSummary {
  int frames = 0;
  int seen_frames = 0;                    ///< with any joint
  int first_frame = -1, last_frame = -1;  ///< with any joint, from 0 on; -1: none
  int longest_gap_frames = 0;             ///< without any joint, between frames with some
  long long missing_joints = 0;           ///< of all joints of all frames
  std::vector<double> joint_seen_share;   ///< [joints] of the frames
  double height_px = 0;                   ///< of the box around all joints; median over seen frames
  /// Standard deviation of what changes from frame to frame, in x and y alike: the median of second
  /// differences over all joints, as for white noise. Fast motion adds to it. NaN: there are none.
  double jitter_px = 0;
};

TrackSummary summarize(const Track2d& track);

}  // namespace mcdbn
