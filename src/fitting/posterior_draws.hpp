#pragma once

#include <cstdint>
#include <vector>

#include "fitting/clip_posterior.hpp"

namespace mcdbn {

/// Motions that are as likely as the posterior has them: draws of the normal distribution that it
/// is near its likeliest point, whose inverse covariance is JᵀJ of the weighted residuals'
/// (Laplace's approximation), made wider by `settings.draw_width_factor`. Orientations that move no
/// seen joint are drawn, too. Windows of a long clip are drawn by themselves, of one body.
/// @param likeliest as map_solution found it
std::vector<PosteriorPoint> posterior_draws(const PosteriorClip& clip, const RayNoise& noise,
                                            const TrackFitSettings& settings,
                                            const PosteriorPoint& likeliest, std::size_t count,
                                            std::uint64_t seed);

}  // namespace mcdbn
