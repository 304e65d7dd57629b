#pragma once

#include <vector>

#include "mcdbn/machines/regeneration.hpp"

namespace mcdbn {

/// The mean-field answer to a sequence of the first modality that is still growing: what
/// coded_answers gives of the second, at a cost for each frame that does not grow. Settled frames
/// are history: of the first modality as many rows as its CDBN sees, of the second the visible
/// units of every layer. The newest frames are open: they may be shown otherwise each time, and are
/// inferred and decoded anew on that history.
class RunningRegeneration {
 public:
  /// @param network of two modalities, which has to outlive this
  /// @param run_in as RegenerationOptions::run_in  @throws ShapeError if there are others
  explicit RunningRegeneration(const Mcdbn& network,
                               std::size_t run_in = RegenerationOptions{}.run_in);

  /// The answer to the open frames, of which the last is taken for the sequence's end.
  /// @param open standardized, the first follows the settled ones [frames x dimension], NaN where
  ///        it is unknown  @throws ShapeError
  CodedAnswer answer(const MatrixF& open);
  /// The first `frames` of the last answer are not asked again. @throws ShapeError if it had fewer
  void settle(std::size_t frames);

 private:
  MatrixF filled(const MatrixF& open) const;
  MatrixF rows_to_see(const MatrixF& open) const;
  std::vector<Matrix> visible_to_go_on(Eigen::Index rows) const;

  const Mcdbn& network_;
  Eigen::Index history_;      ///< frames before the first that is decoded
  Eigen::Index run_in_;       ///< frames still to be run in before the first open one
  Eigen::Index settled_ = 0;  ///< frames; before the first, the history repeats it
  MatrixF shown_;  ///< the last history_ frames of the first modality; none settled yet: 0 rows
  std::vector<MatrixF> visible_;  ///< of each layer of the second, in its own units
  // All of the last answer, in these rows: history, run-in, open frames.
  MatrixF last_shown_;
  std::vector<MatrixF> last_visible_;
};

}  // namespace mcdbn
