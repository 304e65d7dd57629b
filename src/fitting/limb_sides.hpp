#pragma once

#include <cstddef>
#include <vector>

#include "fitting/clip_posterior.hpp"
#include "fitting/clip_windows.hpp"

namespace mcdbn {

/// A bone, parent to joint, whose orientation turns no other bone.
struct Bone {
  int turn = 0;
  std::size_t joint = 0;
};

/// A chain of bones from the trunk on: an arm, a leg, a head.
using Limb = std::vector<Bone>;

/// @param clip of one frame at least
std::vector<Limb> limbs_of(const PosteriorClip& clip);

/// Turns of a limb on other sides than a solution's, over some frames.
struct OtherSides {
  ClipWindow stretch;
  MatrixD turns;  ///< [frames of the stretch x 3·bones] radians, camera axes
};

/// Where a limb is likelier with some of its bones on the other side in depth. The ray of a bone's
/// lower end meets the sphere of its length about the upper end twice: towards the camera and away.
/// The sequence of sides with the least energy is found (Viterbi); the energy is the prior's of the
/// limb's turns alone, and a turn about the bone is the prior's.
/// @return the stretches in which the sides are not those of `point`, each at least two frames long
std::vector<OtherSides> likelier_sides(const PosteriorClip& clip, const RayNoise& noise,
                                       const TrackFitSettings& settings,
                                       const PosteriorPoint& point, const Limb& limb);

}  // namespace mcdbn
