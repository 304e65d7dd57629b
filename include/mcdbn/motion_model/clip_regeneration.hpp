#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "mcdbn/camera/track.hpp"
#include "mcdbn/fitting/track_fit.hpp"
#include "mcdbn/machines/regeneration.hpp"
#include "mcdbn/motion_model/model_file.hpp"

namespace mcdbn {

/// What is known of a regenerated clip, and how near it is to come to its track.
struct ClipPlacement : KnownOfClip {
  std::optional<TrackFitSettings> fit =
      TrackFitSettings{};  ///< unset: the network's answer as it is
};

/// The features of a track of which parts are out of sight for long, with what an answer to the
/// rest shows there in place of NaN; the answer to that fills them anew, in rounds.
/// @param features standardized 2D of `track` [frames x dimension], NaN where joints are missing
/// @param answer standardized 3D [frames x dimension] to such features, its own guess for NaN
/// @return the same where nothing is missing
/// @throws InputError if next to nothing of the person is seen, as fit_to_track does
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

/// The other direction: a 2D track from 3D motion, `samples` times, one frame for each of the clip
/// at the model's rate. Everything in it is the network's answer, the root's place in the image and
/// the body's size too; nothing is fitted or projected.
/// @param clip any skeleton with the model's joint names, at any rate
/// @param camera whose axes the motion is seen along and whose image the pixels are of; unset: the
///        model's own view. Its place is not asked: the network knows one.
/// @return the root first, then the other joints of the model
/// @throws InputError if the clip lacks a joint of the model
std::vector<Track2d> regenerate_track(const Model& model, const Motion& clip,
                                      const RegenerationOptions& options,
                                      const std::optional<Camera>& camera = {});

}  // namespace mcdbn
