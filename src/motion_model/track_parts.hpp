#pragma once

#include <vector>

#include "base/fade_in.hpp"
#include "mcdbn/camera/track.hpp"
#include "mcdbn/camera/track_stretches.hpp"

namespace mcdbn {

/// Frames that are regenerated together. Memory grows with them, so that a long track is
/// regenerated in parts.
struct TrackPart {
  FrameRange range;
  int shared = 0;  ///< of its first frames, those that the part before it has too

  /// How much this part counts in its frame `t`, beside the one before.
  double share(int t) const { return fade_in(t, shared); }
};

/// Parts of five minutes, each with two seconds of its neighbours on either side: further away
/// nothing of them is felt. One in which hardly a joint is seen is one with the part before it.
std::vector<TrackPart> parts_of(const Track2d& track, const FrameRange& stretch);

}  // namespace mcdbn
