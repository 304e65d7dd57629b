#pragma once

#include "camera/track_rays.hpp"
#include "mcdbn/features/pose_features.hpp"
#include "mcdbn/fitting/track_fit.hpp"

namespace mcdbn {

/// Moves an answer so that its joints lie where the track shows them. The answer is the prior mean:
/// every orientation is turned about the camera's axes, and the root shifted, as is most likely
/// given the track and the frames around (Gauss-Newton per frame, in rounds; joints that nothing
/// likely explains are let go of; feet that stand still on the image come no nearer either).
/// How much the track counts is told from the clip: from how well it can be met at all, so that the
/// track of a body of other proportions, or of joints put elsewhere, is not taken at its word. The
/// turns are smoothed over time as much as the track's noise asks for, and fade where joints go
/// missing.
/// @param features [frames x pose_features.dimension()], the answer
/// @param turn_deviation_rad [frames x pose_features.joints()] standard deviation of each
///        orientation about each axis, above 0
/// @param answer the same, decoded, the root where root_trajectory puts it
/// @param track rays of joints of the answer's skeleton
/// @param track_noise_px as track_noise_px(Track2d) tells it
/// @return features with other orientations
/// @throws ShapeError; InputError if the answer lacks a joint of the features or of the track
MatrixD fit_joints(const PoseFeatures& pose_features, const MatrixD& features,
                   const MatrixD& turn_deviation_rad, const Motion& answer, const TrackRays& track,
                   double track_noise_px, const Camera& camera, const TrackFitSettings& fit = {});

}  // namespace mcdbn
