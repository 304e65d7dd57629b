// The room fitting: fits a prior mean and deviation to a 2D track.
// It uses features. Its one entry point is fit_to_track. Also here: root paths, one problem for all
// frames of a clip, its costs; Ceres is included here alone. Add here: a cost, as a file of terms/
// and lines in window_problem.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "mcdbn/camera/assumed_view.hpp"
#include "mcdbn/camera/camera.hpp"
#include "mcdbn/camera/track.hpp"
#include "mcdbn/features/modalities.hpp"
#include "mcdbn/fitting/known_of_clip.hpp"
#include "mcdbn/fitting/pose_prior.hpp"
#include "mcdbn/fitting/track_fit_settings.hpp"
#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// Draws from the posterior, beside the likeliest motion.
struct PosteriorDraws {
  std::size_t count = 0;
  std::uint64_t seed = 1;
};

/// A motion fitted to its track.
struct FittedClip {
  Motion motion;  ///< at the model's rate; on the model's skeleton with the lengths that were
                  ///< found, if none was known
  Track2d shown;  ///< all its joints as the camera sees them; image size as the track's
  Camera camera;  ///< that sees `motion` so, in the skeleton's file units
  AssumedView view = {};  ///< of the camera, where none was known
  /// Whether the prior's mean does not match what the camera shows: the root started from how large
  /// body and image are, and the motion may be far off.
  bool placed_by_size = false;
  /// −log of how likely the motion is given prior and track, but for a constant: of two readings of
  /// a track in which the same joints are seen, that of the lower energy is the likelier. 0 without
  /// settings.
  double energy = 0;
  std::vector<Motion> draws =
      {};  ///< as `motion`, of bodies of their own if the skeleton is not known
};

/// The likeliest motion given a prior and the 2D track: one maximum a posteriori problem for the
/// clip's orientations, its root, and, without `known.skeleton`, the lengths of its bones, left and
/// right alike (docs/concepts.md, The fit). Without settings only the root is put where the track
/// shows it. Without a camera only the path's shape is known: it
/// starts above the origin, at the features' height.
/// @param modalities decode features to poses, and name the joints to look at
/// @param track at the model's rate, as many frames as the prior; joined by name
/// @param settings unset: orientations stay as the prior's mean has them, and draws are what the
///        prior alone leaves open
/// @param draws for these a detector's lasting error lasts throughout, and without settings an
///        orientation's deviation is the prior's, however small: the likeliest motion and its
///        uncertainty take different settings
/// @throws ShapeError; InputError if the skeleton lacks a joint of the model, no frame shows enough
///         joints, or a deviation is negative or not finite
FittedClip fit_to_track(const PosePrior& prior, const Modalities& modalities, const Track2d& track,
                        const KnownOfClip& known, const std::optional<TrackFitSettings>& settings,
                        const PosteriorDraws& draws = {});

}  // namespace mcdbn
