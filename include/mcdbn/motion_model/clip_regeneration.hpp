#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "mcdbn/camera/camera.hpp"
#include "mcdbn/camera/track.hpp"
#include "mcdbn/fitting/track_fit.hpp"
#include "mcdbn/machines/regeneration.hpp"
#include "mcdbn/motion_model/model_file.hpp"

namespace mcdbn {

/// Where a regenerated clip is to stand, and how near to its track.
struct ClipPlacement {
  std::optional<Camera> camera;  ///< unset: the model's own view, the clip put at the origin
  /// The person's own; unset: the model's, and the fit allows for other proportions.
  std::optional<Skeleton> skeleton;
  std::optional<TrackFitSettings> fit =
      TrackFitSettings{};  ///< unset: the network's answer as it is
};

/// The pose as the features say it, the root where the track shows it (root_trajectory). With a fit
/// the joints are turned to where the track shows them (fit_to_track), and feet that stand say how
/// fast the root travels (planted_velocity).
/// @param pose standardized 3D [frames x dimension]  @return the clip at the model's rate
Motion motion_from_features(const Modalities& modalities, const MatrixF& pose, const Track2d& track,
                            const ClipPlacement& placement);

/// The features of a track of which parts are out of sight for long, with what an answer to the
/// rest shows there in place of NaN; the answer to that fills them anew, in rounds.
/// @param features standardized 2D of `track` [frames x dimension], NaN where joints are missing
/// @param answer standardized 3D [frames x dimension] to such features, its own guess for NaN
/// @return the same where nothing is missing
/// @throws InputError if next to nothing of the person is seen, as root_trajectory does
MatrixF fill_gaps(const Modalities& modalities, const MatrixF& features, const Track2d& track,
                  const ClipPlacement& placement,
                  const std::function<MatrixF(const MatrixF&)>& answer);

/// 3D motion from a 2D track, `samples` times. The track is brought to the model's rate and the
/// motion back to the track's: as many frames as the track has.
/// @param filled if given, how many joints were missing
/// @throws InputError if the track lacks a joint of the model
std::vector<Motion> regenerate_clip(const Model& model, const Track2d& track,
                                    const ClipPlacement& placement,
                                    const RegenerationOptions& options,
                                    TrackFeatures::FillCount* filled = nullptr);

}  // namespace mcdbn
