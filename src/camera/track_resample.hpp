#pragma once

#include "mcdbn/camera/track.hpp"

namespace mcdbn {

/// The track on another time grid, linear between frames; going down, each new frame is the
/// triangle-weighted mean of the old ones around it, so that noise and fast motion do not alias.
/// A new frame is missing where all old ones that it draws on are. The same rate returns it as is.
Track2d resample_track(const Track2d& track, double target_hz);

/// One such new frame. @param at its time  @param reach of the triangle, both in frames of the
/// track
/// @return a track of that frame alone
Track2d frame_at(const Track2d& track, double at, double reach);

}  // namespace mcdbn
