#pragma once

#include <vector>

#include "mcdbn/camera/side_swaps.hpp"

namespace mcdbn {

/// The spells of frames in which the arms, or the legs, are seen, between gaps longer than joints
/// are followed (kLongestFollowedGap_s): after such a gap find_side_swaps cannot detect
/// whether the detector's sides are the same as before.
/// @return as swaps of all their places, in the order of frames, legs first; none of limbs without
/// such a gap
std::vector<SideSwap> limb_spells(const Track2d& track);

}  // namespace mcdbn
