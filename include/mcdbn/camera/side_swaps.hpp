#pragma once

#include <string>
#include <vector>

#include "mcdbn/camera/track.hpp"

namespace mcdbn {

/// Longest gap over which joints are followed.
inline constexpr double kLongestFollowedGap_s = 0.2;

enum class LimbPair { arms, legs };

/// Frames in which left and right of a pair of limbs are exchanged.
struct SideSwap {
  LimbPair limbs = LimbPair::legs;
  int first_frame = 0, last_frame = 0;  ///< both swapped
  std::vector<int> left, right;         ///< columns to exchange, those of a place side by side
};

/// Finds swaps over the whole clip: each frame of the arms and of the legs is swapped or not, and
/// the sequence is sought in which the joints jump least, their velocity kept, against a cost of
/// each switch (Viterbi). Those places of a limb are exchanged that jump less for it. If swaps fill
/// more than half of a clip, the rest is taken for swapped.
/// @param track with keypoints; without them nothing is found
std::vector<SideSwap> find_side_swaps(const Track2d& track);

/// The swap in a track with `frames` more frames before it; negative: fewer.
SideSwap moved(SideSwap swap, int frames);

/// Exchanges what find_side_swaps found.
void exchange_sides(Track2d& track, const std::vector<SideSwap>& swaps);

/// "legs swapped in frames 120-134, 150; arms in 7"; empty for none.
/// @param numbers [frames] of the track's frames, as its file has them; none: counted from 0
std::string described(const std::vector<SideSwap>& swaps,
                      const std::vector<long long>& numbers = {});

}  // namespace mcdbn
