#include "machines/answer_batches.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

namespace answer_batches_test {

using namespace mcdbn;

namespace {

/// Sequences of those lengths whose number in frame t is 1000 i + t.
std::vector<MatrixF> numbered(const std::vector<Eigen::Index>& lengths) {
  std::vector<MatrixF> sequences;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    MatrixF sequence(lengths[i], 1);
    for (Eigen::Index t = 0; t < lengths[i]; ++t)
      sequence(t, 0) = static_cast<float>(1000 * static_cast<Eigen::Index>(i) + t);
    sequences.push_back(sequence);
  }
  return sequences;
}

/// Every batch's rows put where they belong. A row that is never written stays NaN.
MatrixF put_together(const std::vector<AnswerBatch>& batches, const std::vector<MatrixF>& sequences,
                     Eigen::Index frames) {
  MatrixF all = MatrixF::Constant(frames, 1, NAN);
  for (const AnswerBatch& batch : batches) {
    const std::vector<MatrixF> rows = rows_of(batch, sequences);
    for (std::size_t i = 0; i < batch.size(); ++i) {
      REQUIRE(rows[i].rows() == batch[i].frames);
      REQUIRE(all.middleRows(batch[i].row, batch[i].frames).array().isNaN().all());
      all.middleRows(batch[i].row, batch[i].frames) = rows[i];
    }
  }
  return all;
}

Eigen::Index longest_of(const AnswerBatch& batch) {
  return std::ranges::max(batch, {}, &SequencePart::frames).frames;
}

/// Frames that a batch takes the memory of.
Eigen::Index padded_frames(const AnswerBatch& batch) {
  return longest_of(batch) * static_cast<Eigen::Index>(batch.size());
}

}  // namespace

TEST_CASE("answer batches: every frame once, in its place, and never more than so many at once") {
  const std::vector<MatrixF> sequences = numbered({7, 190, 3, 40, 12, 201, 1, 33, 60, 8});
  const std::vector<AnswerBatch> batches = answer_batches(sequences, 1, 60);
  for (const AnswerBatch& batch : batches) CHECK(padded_frames(batch) <= 60);
  const MatrixF all = put_together(batches, sequences, 555);
  Eigen::Index row = 0;
  for (const MatrixF& sequence : sequences) {
    CHECK(all.middleRows(row, sequence.rows()) == sequence);
    row += sequence.rows();
  }
  // 190 frames are 4 parts of 47 and 48, 201 are 4 of 50 and 51; all but the parts of 8 to 12 are
  // more than half of 60.
  CHECK(batches.size() == 12);
}

TEST_CASE("answer batches: one long sequence does not make the short ones as long") {
  std::vector<Eigen::Index> lengths(40, 10);
  lengths[17] = 400;
  const auto sequences = numbered(lengths);
  const std::vector<AnswerBatch> batches = answer_batches(sequences, 1, 400);
  REQUIRE(batches.size() == 2);
  CHECK(batches[0].size() == 1);
  CHECK(batches[1].size() == 39);
}

TEST_CASE(
    "answer batches: few frames are one batch, in order; of every n-th sequence the others are "
    "left out") {
  const std::vector<MatrixF> sequences = numbered({5, 9, 2, 7, 4});
  const std::vector<AnswerBatch> all = answer_batches(sequences, 1, 45);
  REQUIRE(all.size() == 1);
  for (std::size_t i = 0; i < 5; ++i) CHECK(all[0][i].sequence == i);
  const std::vector<AnswerBatch> some = answer_batches(sequences, 2, 45);
  REQUIRE(some.size() == 1);
  CHECK(rows_of(some[0], sequences) ==
        std::vector<MatrixF>{sequences[0], sequences[2], sequences[4]});
  CHECK(some[0][2].row == 7);
  CHECK(answer_batches({}, 1, 45).empty());
}

}  // namespace answer_batches_test
