#pragma once

#include <span>

#include "device/losses.hpp"
#include "mcdbn/base/random.hpp"
#include "mcdbn/device/matrix.hpp"

namespace mcdbn {

/// Where in its training a mini-batch stands.
struct LearningStep {
  std::size_t epoch = 1;  ///< from 1
  double progress = 0;    ///< 0 … 1, of all mini-batches
  RandomKey random;       ///< its draws: phase 0 on
  /// What was seen of the first sequence, in the same rows of a matrix of its own
  /// (Sequences::seen); none: all of it.
  const Matrix* seen = nullptr;
};

/// How a machine learns from mini-batches: what its gradient is, and how its parameters move. One
/// file for each (contrastive_divergence.hpp, multi_prediction.hpp); greedy_schedule.cpp runs any
/// of them.
class LearningRule {
 public:
  virtual ~LearningRule() = default;
  /// Losses that a mini-batch adds up, each a mean over units.
  virtual std::size_t loss_count() const = 0;
  /// One mini-batch: enqueues and returns.
  /// @param visible the current frames, indexed, for each sequence that the machine sees
  /// @throws ShapeError
  virtual void learn(std::span<const Rows> visible, const LearningStep& step,
                     LossAccumulator& losses) = 0;
  /// State that is kept from one mini-batch to the next, without the machine's parameters.
  virtual void visit_state(TrainingState& state) = 0;
};

}  // namespace mcdbn
