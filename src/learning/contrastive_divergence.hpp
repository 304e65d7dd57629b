#pragma once

#include "device/optimizer.hpp"
#include "device/row_tile.hpp"
#include "learning/learning_rule.hpp"
#include "mcdbn/learning/settings.hpp"
#include "mcdbn/machines/crbm.hpp"

namespace mcdbn {

/// What one mini-batch of CD-k does to the parameters.
struct CdRule {
  std::size_t gibbs_steps = 1;
  UpdateRule W;  ///< the biases take the same without decay
  UpdateRule A, B;
};
/// What the settings say for an epoch, counted from 1.
CdRule cd_rule_for(const CdSettings& settings, std::size_t epoch);

/// The tile for CD-k, and for multi-prediction with the larger modality's units: a block's local
/// memory holds its visible and its hidden units. Unset where they do not fit (choose_row_tile).
std::optional<RowTile> choose_chain_tile(const Device& device, const CrbmShape& shape,
                                         std::size_t batch);

/// Contrastive divergence for one CRBM or RBM (Algorithm 2 with its errata, docs/paper.md: the data
/// are clamped once, then k Gibbs steps, then one update). Hidden units are sampled,
/// reconstructions of the visible ones are means, the last hidden step keeps probabilities.
///
/// A mini-batch is two launches (contrastive_divergence.cl, contrastive_divergence_update.cl) where
/// the chain's state fits the device, else one product after the other; both draw the same numbers.
class ContrastiveDivergence : public LearningRule {
 public:
  ContrastiveDivergence(Crbm& crbm, std::size_t largest_batch, const CdSettings& settings = {},
                        OptimizerKind optimizer = OptimizerKind::momentum);
  /// With a tile of the caller's, or without the fused kernels.
  ContrastiveDivergence(Crbm& crbm, std::size_t largest_batch, std::optional<RowTile> tile,
                        const CdSettings& settings = {},
                        OptimizerKind optimizer = OptimizerKind::momentum);

  std::size_t loss_count() const override { return 1; }
  /// step() by the rule that the settings say. @param visible one
  void learn(std::span<const Rows> visible, const LearningStep& step,
             LossAccumulator& losses) override;

  /// One mini-batch: enqueues and returns. The draws are those of `key` with phase = Gibbs step.
  /// Adds the mean squared reconstruction error of a unit to `losses` slot 0.
  /// @param rows the current frames, indexed, at most `largest_batch` of them  @throws ShapeError
  void step(const Rows& rows, const CdRule& rule, const RandomKey& key, LossAccumulator& losses);

  /// Unset where mini-batches are composed.
  const std::optional<RowTile>& tile() const { return tile_; }
  /// The gradient of the last step, downhill, where the optimizer is none; for tests.
  CrbmParameters gradients();

 private:
  void composed_step(const Rows& rows, const CdRule& rule, const RandomKey& key,
                     LossAccumulator& losses);
  void clamp_data(const Rows& rows, const RandomKey& key);
  void gibbs_chain(std::size_t count, std::size_t gibbs_steps, RandomKey key);
  void composed_gradients(const Rows& rows);

  void fused_chain(const Rows& rows, std::size_t gibbs_steps, const RandomKey& key);
  void fused_update(const Rows& rows, const CdRule& rule, LossAccumulator& losses);

  Crbm& crbm_;
  CdSettings settings_;
  std::optional<RowTile> tile_;
  Optimizer optimizer_;
  // Dynamic biases while the chain runs; the fused chain leaves data − reconstruction there.
  Matrix visible_data_, visible_, visible_bias_;  // [batch x visible]
  Matrix hidden_data_, hidden_, hidden_bias_;     // [batch x hidden]
  Matrix row_losses_;                             // [1 x batch], fused
  // Composed only.
  Matrix hidden_sample_;
  std::optional<CrbmMatrices> gradient_;  // the optimizer's
};

}  // namespace mcdbn
