#pragma once

#include <optional>

#include "mcdbn/fitting/track_fit.hpp"

namespace mcdbn {

/// What pitch and roll of a camera are expected to be, as they differ from those that it is assumed
/// to have: angles and their deviations, radians. Pitch is how far it looks down, roll its turn
/// clockwise, seen from behind.
struct ExpectedLean {
  double pitch = 0, roll = 0, pitch_deviation = 1, roll_deviation = 1;
};

/// What is not known of a camera.
struct UnknownCamera {
  ExpectedLean usual;     ///< as cameras stand
  ExpectedLean balanced;  ///< as makes the body stand over its feet
  bool pitch_known = false, roll_known = false, focal_known = false;
  double log_focal = 0;  ///< expected
  double log_focal_deviation = 1;
};

/// What is not known of the camera, where the network sees and answers in a level view: nothing
/// determines pitch and roll where it does not.
std::optional<UnknownCamera> unknown_camera_of(const KnownOfClip& known,
                                               const Modalities& modalities, const Track2d& track,
                                               const TrackFitSettings& settings);

}  // namespace mcdbn
