// The room fitting: where an answer meets the track that it answers: the fit, root paths,
// smoothing. It uses features. Add here: a cost of the fit.
#pragma once

#include <string>
#include <vector>

#include "mcdbn/camera/camera.hpp"
#include "mcdbn/features/pose_features.hpp"

namespace mcdbn {

/// How far an answer may be bent to meet the track.
struct TrackFitSettings {
  double turn_deg = 25;     ///< standard deviation of an orientation about each axis
  double change = 0.4;      ///< of a turn from those of the frames around it, as a share of it
  double likeness = 0.5;    ///< correlation of a joint's turn with its parent's
  double position_m = 0.1;  ///< standard deviation of the root's place, on a 1.7 m body
  /// How far a foot that stands still on the image strays from the depth that it has in the frames
  /// around, on a 1.7 m body.
  double footing_m = 0.0125;
  double caution = 2;  ///< how many times the track's noise it is taken to be off by
  /// How far, at least, joints are from where a body of the skeleton's proportions has them, on a
  /// 1.7 m body: for a skeleton that is not the person's own.
  double proportions_m = 0;
  /// How fast the answer's error changes (RMS of its acceleration, on a 1.7 m body): with the
  /// track's noise it says over how many frames to smooth.
  double bend_m_s2 = 0.7;
  double fade_s = 0.1;  ///< how long a joint's correction outlives the joint's last observation
};

/// Moves an answer so that its joints lie where the track shows them. The answer is the prior:
/// every orientation is turned about the camera's axes, and the root shifted, as is most likely
/// given the track and the frames around (Gauss-Newton per frame, in rounds; joints that nothing
/// likely explains are let go of; feet that stand still on the image come no nearer either).
/// How much the track counts is told from the clip: from how well it can be met at all, so that the
/// track of a body of other proportions, or of joints put elsewhere, is not taken at its word. The
/// turns are smoothed over time as much as the track's noise asks for, and fade where joints go
/// missing.
/// @param features [frames x pose_features.dimension()], the answer
/// @param answer the same, decoded, the root where root_trajectory puts it
/// @param joint_names the joints to look at; those that the track or the answer lacks are ignored
/// @return features with other orientations
/// @throws ShapeError; InputError if the answer lacks a joint of the features
MatrixD fit_to_track(const PoseFeatures& pose_features, const MatrixD& features,
                     const Motion& answer, const std::vector<std::string>& joint_names,
                     const Track2d& track, const Camera& camera, const TrackFitSettings& fit = {});

}  // namespace mcdbn
