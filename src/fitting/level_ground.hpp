#pragma once

#include "mcdbn/camera/assumed_view.hpp"
#include "mcdbn/fitting/track_fit.hpp"

namespace mcdbn {

/// What is likely of a camera that nobody calibrated, and of people who are seen by it. Metres are
/// those of a 1.7 m body.
struct LevelGroundSettings {
  double pitch_deg = 10;   ///< deviation of pitch beforehand: by hand, from a stand, a ceiling
  double roll_deg = 3;     ///< of roll: who films takes care of it
  double height_m = 0.05;  ///< of the lower foot's height on level ground
  double depth_m = 0.1;    ///< of an answer's distance from the camera
  double balance_deg = 5;  ///< of the body's middle from straight above the feet, on average
  double witness_s = 0.5;  ///< a step: frames within it tell the same
};

/// The view that makes the ground level under the clip's feet and the body balanced over them, as
/// far as those are surer than what cameras are like: the likeliest pitch, then the likeliest roll.
/// What was said stays.
/// @param clip of the camera as it is assumed now  @param now pitch and roll of that camera
AssumedView levelled_view(const AssumedView& said, const FittedClip& clip,
                          const LevelGroundSettings& settings = {});

}  // namespace mcdbn
