#pragma once

#include <Eigen/Core>

#include "fitting/clip_posterior.hpp"
#include "fitting/slow_process.hpp"

namespace mcdbn {

/// What the errors of the prior's mean are as a process in time. Where rays are exact its values
/// count for less (`TrackFitSettings::exact`), its bends as elsewhere.
SlowProcess prior_errors(const PosteriorClip& clip, const RayNoise& noise,
                         const TrackFitSettings& settings);

/// What a turn of its parent by one makes one expect of a turn; 0 without a parent.
double share_of_parent(const PosteriorClip& clip, const TrackFitSettings& settings,
                       Eigen::Index frame, int turn);

/// Deviation of a turn from what its parent makes one expect, about each axis.
double own_deviation_rad(const PosteriorClip& clip, const TrackFitSettings& settings,
                         Eigen::Index frame, int turn);

}  // namespace mcdbn
