#include "camera/limb_spells.hpp"

#include "camera/keypoint_pairs.hpp"

namespace mcdbn {

std::vector<SideSwap> limb_spells(const Track2d& track) {
  const auto longest_gap = static_cast<int>(kLongestFollowedGap_s * track.fps);
  std::vector<SideSwap> all;
  for (const LimbPair limbs : {LimbPair::legs, LimbPair::arms}) {
    const LimbPairs pairs =
        limbs == LimbPair::legs ? leg_pairs(track.keypoints) : arm_pairs(track.keypoints);
    std::vector<SideSwap> spells;
    for (int t = 0; t < track.frames(); ++t) {
      bool seen = false;
      for (const auto& [left, right] : pairs.distal)
        seen = seen || track.confidence(t, left) > 0 || track.confidence(t, right) > 0;
      if (!seen) continue;
      if (spells.empty() || t - spells.back().last_frame > longest_gap + 1) {
        spells.push_back({limbs, t, t, {}, {}});
        for (const auto& [left, right] : pairs.columns) {
          spells.back().left.push_back(left);
          spells.back().right.push_back(right);
        }
      }
      spells.back().last_frame = t;
    }
    if (spells.size() > 1) all.insert(all.end(), spells.begin(), spells.end());
  }
  return all;
}

}  // namespace mcdbn
