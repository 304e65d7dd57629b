#pragma once

#include <cstdint>
#include <vector>

#include "fitting/clip_posterior.hpp"

namespace mcdbn {

/// Motions that are as likely as the prior alone has them, where no track is met: orientations are
/// off by its deviations, as likely as not the way their parents are (settings.likeness) and the
/// same way throughout; where the body is unknown its lengths are off, too (settings.people).
/// @param clip whose turn_deviation_rad is told
std::vector<PosteriorPoint> prior_draws(const PosteriorClip& clip, const TrackFitSettings& settings,
                                        std::size_t count, std::uint64_t seed);

}  // namespace mcdbn
