#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

/// Frames that are answered together: enough to keep a device busy.
inline constexpr Eigen::Index kFramesInStep = 4800;

/// Frames of one sequence that a network answers as a sequence of their own.
struct SequencePart {
  std::size_t sequence = 0;
  Eigen::Index first = 0, frames = 0;
  Eigen::Index row = 0;  ///< of the first frame, where all parts stand below each other
};

/// Parts that are answered together, frame by frame, in their sequences' order.
using AnswerBatch = std::vector<SequencePart>;

/// All frames of every n-th of `sequences`. A batch, whose memory is that of its longest part as
/// often as it has parts, has at most `most_frames` so, whatever the sequences' lengths: parts of
/// like length go together, and a sequence of more frames is cut evenly.
/// @param every, most_frames above 0
std::vector<AnswerBatch> answer_batches(std::span<const MatrixF> sequences, std::size_t every,
                                        Eigen::Index most_frames);

/// Frames of all of them.
Eigen::Index total_frames(std::span<const MatrixF> sequences);

/// Rows of the batch's parts, one matrix a part.
std::vector<MatrixF> rows_of(const AnswerBatch& batch, std::span<const MatrixF> sequences);

}  // namespace mcdbn
