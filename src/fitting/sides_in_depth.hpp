#pragma once

#include "fitting/clip_posterior.hpp"

namespace mcdbn {

/// The likelier of what one camera hardly distinguishes: a bone that points towards it or away.
/// Where a limb's other sides are likelier by themselves (`likelier_sides`) a window about them is
/// solved from there. All that is likelier then stays, all frames are solved anew, and windows that
/// overlap its own are tried again. Worth while where rays are exact: elsewhere a solution gets
/// from one side to the other by itself, and the prior determines which is likelier.
/// @param point a solution of a clip of one frame at least
/// @return what all frames come to from there; `point` where no other sides are likelier
PosteriorPoint likeliest_in_depth(const PosteriorClip& clip, const RayNoise& noise,
                                  const TrackFitSettings& settings, PosteriorPoint point);

/// As likeliest_in_depth(), for a track that seems to be exact: solved again and again, each time
/// with rays of less noise. Where the track has no such noise, the energy hardly grows and sides
/// are distinguished better; where it has some, a solution follows it, and the energy grows by more
/// than `TrackFitSettings::exact_energy_ratio`.
/// @param noise in: as estimated from the track; out: as it was lowered to
/// @param least lower bound of `noise.white`
PosteriorPoint likeliest_of_exact(const PosteriorClip& clip, RayNoise& noise,
                                  const TrackFitSettings& settings, double least,
                                  PosteriorPoint point);

}  // namespace mcdbn
