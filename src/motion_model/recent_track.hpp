#pragma once

#include "mcdbn/camera/track.hpp"
#include "mcdbn/camera/track_frame.hpp"

namespace mcdbn {

/// Adds a frame at the track's end.
void append(Track2d& track, const TrackFrame& frame);
/// Takes its first frames away.
void drop_first(Track2d& track, Eigen::Index frames);
/// A track of the same joints, rate and image.
Track2d without_frames(Track2d track);
/// Some of its frames.
Track2d some_frames(const Track2d& track, Eigen::Index first, Eigen::Index count);
/// Puts frames in the place of those from `first` on. @param part of the same joints
void replace_frames(Track2d& track, Eigen::Index first, const Track2d& part);

}  // namespace mcdbn
