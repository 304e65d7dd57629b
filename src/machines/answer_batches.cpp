#include "machines/answer_batches.hpp"

#include <algorithm>
#include <functional>

namespace mcdbn {
namespace {

AnswerBatch all_parts(std::span<const MatrixF> sequences, std::size_t every,
                      Eigen::Index most_frames) {
  AnswerBatch parts;
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < sequences.size(); i += every) {
    const Eigen::Index frames = sequences[i].rows();
    const Eigen::Index count = (frames + most_frames - 1) / most_frames;
    for (Eigen::Index k = 0; k < count; ++k) {
      const Eigen::Index first = k * frames / count, end = (k + 1) * frames / count;
      parts.push_back({i, first, end - first, row + first});
    }
    row += frames;
  }
  return parts;
}

}  // namespace

std::vector<AnswerBatch> answer_batches(std::span<const MatrixF> sequences, std::size_t every,
                                        Eigen::Index most_frames) {
  AnswerBatch parts = all_parts(sequences, every, most_frames);
  std::ranges::stable_sort(parts, std::greater<>{}, &SequencePart::frames);
  std::vector<AnswerBatch> batches;
  Eigen::Index longest = 0;
  for (const SequencePart& part : parts) {
    if (batches.empty() ||
        longest * static_cast<Eigen::Index>(batches.back().size() + 1) > most_frames) {
      batches.emplace_back();
      longest = part.frames;
    }
    batches.back().push_back(part);
  }
  for (AnswerBatch& batch : batches) std::ranges::sort(batch, {}, &SequencePart::row);
  return batches;
}

Eigen::Index total_frames(std::span<const MatrixF> sequences) {
  Eigen::Index frames = 0;
  for (const MatrixF& sequence : sequences) frames += sequence.rows();
  return frames;
}

std::vector<MatrixF> rows_of(const AnswerBatch& batch, std::span<const MatrixF> sequences) {
  std::vector<MatrixF> rows;
  rows.reserve(batch.size());
  for (const SequencePart& part : batch)
    rows.emplace_back(sequences[part.sequence].middleRows(part.first, part.frames));
  return rows;
}

}  // namespace mcdbn
