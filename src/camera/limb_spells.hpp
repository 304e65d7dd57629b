#pragma once

#include <vector>

#include "mcdbn/camera/side_swaps.hpp"

namespace mcdbn {

/// Where the arms, or the legs, are seen after nothing of them was for longer than joints are
/// followed (SideSwapSettings::longest_gap_s): find_side_swaps cannot tell whether a detector came
/// back to them with the same sides.
/// @return as swaps of all their places, in the order of frames, legs first; none of limbs that are
/// never so long out of sight
std::vector<SideSwap> limb_spells(const Track2d& track, const SideSwapSettings& settings = {});

}  // namespace mcdbn
