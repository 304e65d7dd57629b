#pragma once

#include <cstddef>
#include <vector>

#include "fitting/clip_posterior.hpp"
#include "fitting/clip_windows.hpp"

namespace mcdbn {

/// The way from a joint's parent to it, if nothing else hangs on the orientation that turns it.
struct Bone {
  int turn = 0;
  std::size_t joint = 0;
};

/// Bones that hang from each other, from the trunk on: an arm, a leg, a head.
using Limb = std::vector<Bone>;

/// @param clip of one frame at least
std::vector<Limb> limbs_of(const PosteriorClip& clip);

/// A limb otherwise than a solution has it, over some frames.
struct OtherSides {
  ClipWindow stretch;
  MatrixD turns;  ///< [frames of the stretch x 3·bones] radians, camera axes
};

/// Where a limb is likelier with some of its bones on the other side in depth. The ray of a bone's
/// lower end meets the sphere of its length about the upper end twice: towards the camera and away.
/// Of all sequences of such sides the one of the least energy is found (Viterbi), where the energy
/// is the prior's of the limb's turns alone and a turn about the bone is the prior's.
/// @return the stretches in which it is not as `point` has it, each at least two frames long
std::vector<OtherSides> likelier_sides(const PosteriorClip& clip, const RayNoise& noise,
                                       const TrackFitSettings& settings,
                                       const PosteriorPoint& point, const Limb& limb);

}  // namespace mcdbn
