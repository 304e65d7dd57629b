#pragma once

#include <vector>

#include "mcdbn/learning/sequence_source.hpp"

namespace mcdbn {

/// What a frame of each clip weighs in the draw of mini-batches, so that groups of clips are drawn
/// as their frames to the power: 1: every frame alike; 0: every group alike. For clips that were
/// drawn by another power already it is what is left to weigh.
std::vector<double> clip_weights(const SynchronizedClips& clips, double power);

}  // namespace mcdbn
