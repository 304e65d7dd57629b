#pragma once

#include <vector>

#include "mcdbn/learning/sequence_source.hpp"

namespace mcdbn {

/// Weight of a frame of each clip in the draw of mini-batches, such that groups of clips are drawn
/// in proportion to their frames to the power: 1: every frame alike; 0: every group alike. For
/// clips that were drawn by another power already, the weight makes up the difference.
std::vector<double> clip_weights(const SynchronizedClips& clips, double power);

}  // namespace mcdbn
