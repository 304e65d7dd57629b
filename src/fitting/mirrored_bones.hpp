#pragma once

#include "fitting/clip_posterior.hpp"

namespace mcdbn {

/// The likelier of what one camera hardly tells apart: whether a bone points towards it or away.
/// Every bone is mirrored in depth over each stretch of frames in which it stays on one side of
/// lying across the line of sight, alone, then with all below it, and a window about the stretch is
/// solved from there. The likelier ones stay, all frames are solved anew, and what meets them is
/// tried again. Worth while where rays are exact: elsewhere a solution gets from one side to the
/// other by itself, and the prior tells which is likelier.
/// @param point a solution of a clip of one frame at least
/// @return what all frames come to from there; `point` where nothing mirrored is likelier
PosteriorPoint likeliest_in_depth(const PosteriorClip& clip, const RayNoise& noise,
                                  const TrackFitSettings& settings, PosteriorPoint point);

}  // namespace mcdbn
