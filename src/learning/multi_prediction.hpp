#pragma once

#include "device/optimizer.hpp"
#include "device/row_tile.hpp"
#include "learning/learning_rule.hpp"
#include "mcdbn/learning/mrbm_settings.hpp"
#include "mcdbn/machines/mrbm.hpp"

namespace mcdbn {

/// Multi-prediction MinVI training of the MRBM (eq 42; Goodfellow et al., Sohn et al.): each
/// modality is predicted from all others by the unrolled mean field of eq 32 and 33, and the
/// cross-entropy of that prediction (half the squared error, if its units are Gaussian) is
/// back-propagated through all steps, in every direction.
///
/// A mini-batch is taken in parts of at most kMostPartRows rows, each gathered and taken in two
/// launches, and a last launch (multi_prediction.cl, multi_prediction_update.cl) where a block of
/// rows fits the device's local memory, else in one product after another.
class MultiPrediction : public LearningRule {
 public:
  /// @throws ConfigError without a mean-field step
  MultiPrediction(Mrbm& mrbm, std::size_t batch, const MrbmSettings& settings,
                  OptimizerKind optimizer = OptimizerKind::adam);
  /// With a tile of the caller's, or without the fused kernels.
  MultiPrediction(Mrbm& mrbm, std::size_t batch, const MrbmSettings& settings,
                  std::optional<RowTile> tile, OptimizerKind optimizer = OptimizerKind::adam);

  std::size_t loss_count() const override { return mrbm_.modality_count(); }
  /// step() by the rule that the settings specify. @param visible the codes of each modality
  void learn(std::span<const Rows> visible, const LearningStep& step,
             LossAccumulator& losses) override;
  void visit_state(TrainingState& state) override { optimizer_.visit_state(state); }

  /// One mini-batch with its update: enqueues and returns. Adds to `losses` the mean loss of a
  /// unit: in slot m that of the modality m, predicted from the others.
  /// @param codes the same windows' of each modality, indexed, `batch` of them  @throws ShapeError
  void step(const std::vector<Rows>& codes, const UpdateRule& rule, LossAccumulator& losses);

  /// The gradients of eq 42 (mean over the mini-batch, summed over all directions) of the last
  /// step, where they are kept: composed, or with the optimizer none; for tests.
  MrbmParameters gradients();

 private:
  /// Adds the gradients of −log p(modality q | the others).
  void back_propagate(std::size_t q, LossAccumulator& losses);
  void unroll(std::size_t q);
  void add_gradients(std::size_t q);
  void make_stacks();
  void make_matrices();

  /// Rows `first` … `first` + `rows` of the mini-batch. In the stacks they are `stride`, so that
  /// blocks are whole.
  struct Part {
    std::size_t first, rows, stride;
  };
  void fused_step(const std::vector<Rows>& codes, const UpdateRule& rule, LossAccumulator& losses);
  void fused_chain(const Part& part);
  void fused_products(const Part& part);
  void fused_update(const UpdateRule& rule, LossAccumulator& losses);
  Defines fused_defines() const;
  Defines update_defines() const;
  std::size_t piece_steps() const;
  std::size_t pieces() const;

  /// Rows of a part: few enough that the steps of its mean field, which the gradients read again,
  /// stay in a CPU's cache.
  static constexpr std::size_t kMostPartRows = 100;
  /// Rows of the stacks that are added up at once: two pieces should fit a core's cache.
  static constexpr std::size_t kPieceRows = 1024;

  Mrbm& mrbm_;
  MrbmSettings settings_;
  std::size_t steps_, batch_;
  std::size_t part_rows_;  ///< of a part, the last may have fewer; composed: the batch
  std::optional<RowTile> tile_;
  std::size_t block_;  ///< rows of one mean-field step in the stacks: a part's, in whole blocks
  Optimizer optimizer_;
  // Stacks of all modalities [1 x floats] as multi_prediction.cl has them, fused.
  Matrix codes_, stacked_values_, stacked_value_errors_;
  // Composed.
  std::vector<Matrix> target_;                 // [batch x visible]
  std::vector<Matrix> values_, value_errors_;  // [steps·batch x visible], zeros before the values
  // Composed: of one direction; fused: of all, one after the other.
  Matrix present_input_, present_input_error_;  // [block x hidden]
  Matrix hidden_, hidden_errors_;               // [steps·block x hidden]
  Matrix row_losses_;                           // [1 x modalities·batch], fused
  Matrix partial_;                              // of multi_prediction_products, fused
  std::optional<MrbmMatrices> gradient_;        // the optimizer's, composed
};

}  // namespace mcdbn
