#pragma once

#include "mcdbn/camera/seen_frame.hpp"
#include "mcdbn/camera/track.hpp"

namespace mcdbn {

/// Adds a frame at the track's end.
void append(Track2d& track, const SeenFrame& frame);
/// Takes its first frames away.
void drop_first(Track2d& track, Eigen::Index frames);
/// Some of its frames.
Track2d some_frames(const Track2d& track, Eigen::Index first, Eigen::Index count);
/// Puts frames in the place of those from `first` on. @param part of the same joints
void replace_frames(Track2d& track, Eigen::Index first, const Track2d& part);

}  // namespace mcdbn
