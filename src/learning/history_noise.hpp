#pragma once

#include "learning/learning_rule.hpp"
#include "mcdbn/machines/crbm.hpp"

namespace mcdbn {

/// Wraps a rule and adds noise to the history: normal draws to each frame before the current one,
/// new ones in every mini-batch (Taylor and Hinton 2009). A layer that was trained so corrects
/// histories with small errors, as its own output has; else it follows them, and what it generates
/// dies out or grows. The current frame stays as it is.
class HistoryNoise : public LearningRule {
 public:
  /// @param rule of a CRBM of that shape, order at least 1; must live on
  /// @param deviation of the noise, in the units of the data
  HistoryNoise(Device& device, LearningRule& rule, const CrbmShape& shape,
               std::size_t largest_batch, double deviation);

  std::size_t loss_count() const override { return rule_.loss_count(); }
  /// The noise takes phase random_phases::kHistoryNoise of the step's draws.
  void learn(std::span<const Rows> visible, const LearningStep& step,
             LossAccumulator& losses) override;
  void visit_state(TrainingState& state) override { rule_.visit_state(state); }

 private:
  LearningRule& rule_;
  std::size_t frames_;  ///< of a window: the history and the current one
  float deviation_;
  Matrix windows_;       ///< [largest_batch·frames x visible], one window after another
  Matrix seen_;          ///< what was seen, in windows_' shape; what was not gets no noise
  IndexBuffer current_;  ///< the last row of each
};

}  // namespace mcdbn
