#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

/// Synchronized sequences of both modalities, standardized: clip i of each is [frames x dimension],
/// as many frames in both. Holds references only.
struct PairedClips {
  std::span<const MatrixF> tracks, poses;
  /// Which clips belong together (of one person, say), counted from 0; empty: all alike.
  std::span<const std::size_t> groups;
};

/// Where the sequences of a training come from. Here matrices in memory; clips of motion and
/// augmented views of them are motion_model's (training_sources.hpp).
class SequenceSource {
 public:
  virtual ~SequenceSource() = default;
  /// All of them; they live as long as the source. May take a while the first time.
  virtual PairedClips sequences() const = 0;
};

class MatrixSource : public SequenceSource {
 public:
  /// @param groups of the clips, or none
  MatrixSource(std::vector<MatrixF> tracks, std::vector<MatrixF> poses,
               std::vector<std::size_t> groups = {})
      : tracks_(std::move(tracks)), poses_(std::move(poses)), groups_(std::move(groups)) {}
  PairedClips sequences() const override { return {tracks_, poses_, groups_}; }

 private:
  std::vector<MatrixF> tracks_, poses_;
  std::vector<std::size_t> groups_;
};

}  // namespace mcdbn
