#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "mcdbn/camera/side_swaps.hpp"
#include "mcdbn/camera/track.hpp"
#include "mcdbn/fitting/track_fit.hpp"
#include "mcdbn/motion/skeleton_roles.hpp"

namespace mcdbn {

/// What is known of a clip to regenerate, and how it is fitted to its track.
struct ClipPlacement : KnownOfClip {
  std::optional<TrackFitSettings> fit =
      TrackFitSettings{};   ///< unset: the network's answer as it is
  JointMap joint_map = {};  ///< roles of the skeleton's joints, given by hand
  /// Channels of a clip of that skeleton, if there is one: they show how its joints are turned
  /// where its rest pose is not a person's (HumanoidRig).
  MatrixD skeleton_channels = {};
  /// Motions that are drawn for the fit's uncertainty; none: it is not computed.
  PosteriorDraws uncertainty_draws = {};
};

/// A method that infers poses from a track's standardized features [frames x dimension]: a prior of
/// the poses, or standardized poses alone.
using PoseAnswer = std::function<PosePrior(const MatrixF& features)>;

/// The features of a track of which parts are hidden for long, with what an answer to the rest
/// shows there in place of NaN; the answer to these fills them anew, in rounds.
/// @param features standardized 2D of `track` [frames x dimension], NaN where joints are missing
/// @param answer to such features, its own guess for NaN
/// @return the same where nothing is missing
/// @throws InputError if next to nothing of the person is seen, as fit_to_track does
MatrixF fill_gaps(const Modalities& modalities, const MatrixF& features, const Track2d& track,
                  const ClipPlacement& placement, const PoseAnswer& answer);

/// Whether the view is estimated from the clip: no camera is known, the view is not fully given and
/// the model takes cameras other than its own (Modalities::level_view).
bool finds_view(const Modalities& modalities, const KnownOfClip& known);

/// A track as a model sees it.
struct SeenClip {
  MatrixF features;  ///< standardized 2D, nothing missing
  Track2d joints;    ///< the model's joints by name, for fit_to_track
  TrackFeatures::FillCount filled;
  /// View of the camera that is assumed where none is known: what was given, and, where nothing was
  /// given, what was found from the clip: feet stand on level ground.
  AssumedView view;
  /// Swaps that were undone besides those that find_side_swaps() finds, in frames of the model's
  /// rate.
  std::vector<SideSwap> swaps = {};
};

/// The track as a model sees it. Where the columns are the model's joints by name, that is the
/// track, its gaps filled (fill_gaps). Where they are a detector's, or another skeleton's, the
/// joints follow from them by their roles, and the offset between a place and its joint is taken
/// off as the answer has it, in the rounds that fill the gaps. In these the view is found, too.
/// Before them, limbs that reappear after a while are tried with their sides exchanged, if there is
/// a fit: the likelier answer decides.
/// @param track at the model's rate  @param answer as of fill_gaps
/// @throws InputError if the track shows too little of the model's joints; as fill_gaps
SeenClip see_clip(const Modalities& modalities, const Track2d& track,
                  const ClipPlacement& placement, const PoseAnswer& answer);

/// Whether a track's columns are joined with the model's joints by name: the root and two others at
/// least are there.
bool joined_by_name(const Track2d& track, const TrackFeatures& features);

}  // namespace mcdbn
