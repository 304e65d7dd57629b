#pragma once

#include <string>
#include <vector>

#include "mcdbn/base/settings.hpp"
#include "mcdbn/camera/track.hpp"

namespace mcdbn {

/// When a detector is taken to have exchanged left and right. Chosen on training people (CMU's
/// walks and actions, Bandai's; 200 views at 30 Hz). Of legs swapped for up to a second 99, 99 and
/// 97 % of the frames are found where the track is exact, off by 0.2 % and by 0.5 % of body height,
/// and 99, 99 and 98 % of those found are right; of frames without swaps at most 0.06 % are taken
/// for swapped. Of what OpenPose's own swaps, short and of crossing legs, add to the limbs' error
/// 95 % goes.
struct SideSwapSettings {
  double switch_cost = 0.25;
  double most_residual = 0.1;
  double swapped_cost_per_s = 0.15;
  double longest_gap_s = 0.2;

  template <typename Self, typename Visit>
  static void visit(Self& self, const Visit& visit) {
    visit(
        Setting{"switch", above(0, 1000), "body heights",
                "how much less the joints of a limb pair have to jump, all together, for a swap to "
                "begin or end"},
        self.switch_cost);
    visit(Setting{"residual", above(0, 1000), "body heights",
                  "a joint's distance from where its velocity puts it counts up to so much"},
          self.most_residual);
    visit(
        Setting{"swapped", within(0, 1000), "body heights/s",
                "what a swap costs while it lasts: the sides that a clip has for longer are right"},
        self.swapped_cost_per_s);
    visit(Setting{"gap", within(0, 3600), "seconds", "joints are followed over gaps of so long"},
          self.longest_gap_s);
  }
};

enum class LimbPair { arms, legs };

/// Frames in which left and right of a pair of limbs are exchanged.
struct SideSwap {
  LimbPair limbs = LimbPair::legs;
  int first_frame = 0, last_frame = 0;  ///< both swapped
  std::vector<int> left, right;         ///< columns to exchange, those of a place side by side
};

/// Finds them over the whole clip: each frame of the arms and of the legs is swapped or not, and
/// the sequence is sought in which the joints jump least, their velocity kept, against a cost of
/// each switch (Viterbi). Of a limb the places are exchanged that jump less for it. If swaps fill
/// more than half of a clip, the rest is taken for swapped.
/// @param track with keypoints; without them nothing is found
std::vector<SideSwap> find_side_swaps(const Track2d& track, const SideSwapSettings& settings = {});

/// The same in a track that has so many frames more before it, or fewer.
SideSwap moved(SideSwap swap, int frames);

/// Exchanges what find_side_swaps found.
void exchange_sides(Track2d& track, const std::vector<SideSwap>& swaps);

/// "legs swapped in frames 120-134, 150; arms in 7"; empty for none.
/// @param numbers [frames] of the track's frames, as its file has them; none: counted from 0
std::string described(const std::vector<SideSwap>& swaps,
                      const std::vector<long long>& numbers = {});

}  // namespace mcdbn
