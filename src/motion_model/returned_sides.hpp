#pragma once

#include <functional>
#include <vector>

#include "mcdbn/camera/side_swaps.hpp"

namespace mcdbn {

/// Looks again at what find_side_swaps cannot see: each of limb_spells is tried both ways, and
/// exchanged where that is clearly likelier.
/// @param track with keypoints, at the model's rate
/// @param energy of an answer to some seconds of the track (FittedClip::energy)
/// @return what is to be exchanged
std::vector<SideSwap> swapped_spells(Track2d track,
                                     const std::function<double(const Track2d&)>& energy);

}  // namespace mcdbn
