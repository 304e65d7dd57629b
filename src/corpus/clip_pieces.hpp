#pragma once

#include <vector>

#include "mcdbn/corpus/clip_store.hpp"

namespace mcdbn {

/// Frames of clips, or of views, that are kept in memory all at once: some two hours at 30 a
/// second.
inline constexpr double kMostFramesInMemory = 200'000;
/// Frames that are kept of a larger corpus, where some stand for all.
inline constexpr double kSomeFrames = 60'000;
/// Frames of a piece of a clip, where pieces stand for all.
inline constexpr int kPieceFrames = 150;

/// Some of a clip's frames, at its own rate.
struct ClipPiece {
  std::size_t clip = 0;
  int first = 0, frames = 0;
};

/// All clips whole; of more than kMostFramesInMemory pieces spread evenly over all of them,
/// together some kSomeFrames.
std::vector<ClipPiece> pieces_in_memory(const ClipStore& clips, double fps);

}  // namespace mcdbn
