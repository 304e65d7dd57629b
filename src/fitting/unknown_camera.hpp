#pragma once

#include <optional>

#include "mcdbn/camera/track.hpp"
#include "mcdbn/features/modalities.hpp"
#include "mcdbn/fitting/known_of_clip.hpp"
#include "mcdbn/fitting/track_fit_settings.hpp"

namespace mcdbn {

/// Expected differences of a camera's pitch and roll from the assumed ones, and their deviations,
/// radians. Pitch is how far it looks down, roll its turn clockwise, seen from behind.
struct ExpectedLean {
  double pitch = 0, roll = 0, pitch_deviation = 1, roll_deviation = 1;
};

/// Priors of the unknowns of a camera.
struct UnknownCamera {
  ExpectedLean usual;     ///< as cameras stand
  ExpectedLean balanced;  ///< as makes the body stand over its feet
  bool pitch_known = false, roll_known = false, focal_known = false;
  double log_focal = 0;  ///< expected
  double log_focal_deviation = 1;
};

/// The camera's unknowns, if the network sees and answers in a level view: without that, nothing
/// determines pitch and roll.
std::optional<UnknownCamera> unknown_camera_of(const KnownOfClip& known,
                                               const Modalities& modalities, const Track2d& track,
                                               const TrackFitSettings& settings);

}  // namespace mcdbn
