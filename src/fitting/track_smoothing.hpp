#pragma once

#include "mcdbn/camera/track.hpp"

namespace mcdbn {

/// No estimator of 2D joints is better than this, so no track is trusted without limit. (A track
/// made by projection is exact; smooth_track itself leaves it as it is, by a smaller bound.)
inline constexpr double kLeastNoise_px = 0.25;

/// The track's noise, estimated from the track itself: the bulk of the third differences over time,
/// in which motion is small and independent noise counts 20-fold. Over all joints.
/// @return standard deviation in pixels of each coordinate; 0 where no joint is ever seen in four
///         frames in a row
double track_noise_px(const Track2d& track);

/// Takes the noise out: each coordinate by a Rauch-Tung-Striebel smoother whose noise is
/// track_noise_px and whose acceleration is what the coordinate's own second differences have
/// beyond that noise. A clean track stays as it is, and what is missing stays missing.
Track2d smooth_track(const Track2d& track);

}  // namespace mcdbn
