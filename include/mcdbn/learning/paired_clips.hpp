#pragma once

#include <cstddef>
#include <span>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

/// Synchronized sequences of both modalities, standardized: clip i of each is [frames x dimension],
/// as many frames in both. Holds references only.
struct PairedClips {
  std::span<const MatrixF> tracks, poses;
  /// Which clips belong together (of one person, say), counted from 0; empty: all alike.
  std::span<const std::size_t> groups;
};

}  // namespace mcdbn
