#pragma once

#include <cstdint>
#include <vector>

#include "fitting/clip_posterior.hpp"

namespace mcdbn {

/// Draws of the prior alone, without a fit to the track: orientations are off by its deviations,
/// correlated with their parents' errors (settings.parent_correlation), and the same way
/// throughout; where the body is unknown its lengths are off, too (settings.people_log_deviation).
/// @param clip whose turn_deviation_rad is set
std::vector<PosteriorPoint> prior_draws(const PosteriorClip& clip, const TrackFitSettings& settings,
                                        std::size_t count, std::uint64_t seed);

}  // namespace mcdbn
