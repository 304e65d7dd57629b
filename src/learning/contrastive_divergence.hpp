#pragma once

#include "device/optimizer.hpp"
#include "device/row_tile.hpp"
#include "learning/learning_rule.hpp"
#include "mcdbn/learning/cd_settings.hpp"
#include "mcdbn/machines/crbm.hpp"

namespace mcdbn {

/// How one mini-batch of CD-k updates the parameters.
struct CdRule {
  std::size_t gibbs_steps = 1;
  UpdateRule W;  ///< the biases take the same without decay
  UpdateRule A, B;
  bool sample_visible = false;
  float sparsity_target = 0.1F, sparsity_strength = 0.0F;
  float fast_rate = 0.0F;       ///< persistent chains only
  float deviation_rate = 0.0F;  ///< of log σ
};
/// The settings' rule for an epoch, counted from 1. @param progress 0 … 1, of all mini-batches
CdRule cd_rule_for(const CdSettings& settings, std::size_t epoch, double progress = 0.0);

/// Whether the deviation of the machine's units is learnt: the settings have a rate for it, and the
/// machine is a Gaussian RBM.
bool learns_deviation(const CrbmShape& shape, const CdSettings& settings);

/// The tile for CD-k, and for multi-prediction with the larger modality's units: a block's local
/// memory holds its visible and its hidden units. Unset where they do not fit (choose_row_tile).
std::optional<RowTile> choose_chain_tile(const Device& device, const CrbmShape& shape,
                                         std::size_t batch);

/// Contrastive divergence for one CRBM or RBM (Algorithm 2 with its errata, docs/paper.md: the data
/// are clamped once, then k Gibbs steps, then one update). Hidden units are sampled,
/// reconstructions of the visible ones are means unless the settings want them sampled, too; the
/// last hidden step keeps probabilities.
///
/// Options (CdSettings): a target for the hidden units' activity (Hinton 2010, section 11); L1;
/// momentum or Adam; and for a Gaussian RBM the deviation σ of its units, given with the machine or
/// learnt: log p(v) has the derivative ⟨u(u − a − W p(h | u))⟩ − 1 with respect to log σ, u = v/σ,
/// over the data alone.
///
/// A mini-batch is two launches (contrastive_divergence.cl, contrastive_divergence_update.cl),
/// three with a target, where the chain's state fits the device, else one product after the other;
/// both draw the same numbers. With a deviation it is the latter.
class ContrastiveDivergence : public LearningRule {
 public:
  /// @param crbm whose deviation is learnt only if it is a Gaussian RBM
  /// @param optimizer unset: as the settings specify
  /// @throws ConfigError for a machine with a deviation that is no Gaussian RBM
  ContrastiveDivergence(Crbm& crbm, std::size_t largest_batch, const CdSettings& settings = {},
                        std::optional<OptimizerKind> optimizer = {});
  /// With a tile of the caller's, or without the fused kernels.
  ContrastiveDivergence(Crbm& crbm, std::size_t largest_batch, std::optional<RowTile> tile,
                        const CdSettings& settings = {},
                        std::optional<OptimizerKind> optimizer = {});

  std::size_t loss_count() const override { return 1; }
  /// step() by the rule that the settings specify. @param visible one
  void learn(std::span<const Rows> visible, const LearningStep& step,
             LossAccumulator& losses) override;
  void visit_state(TrainingState& state) override;

  /// One mini-batch: enqueues and returns. The draws are those of `key` with phase = Gibbs step for
  /// hidden units, random_phases::kVisibleUnits + Gibbs step for visible ones.
  /// Adds the mean squared reconstruction error of a unit to `losses` slot 0, in the data's units
  /// also where the machine has a deviation.
  /// @param rows the current frames, indexed, at most `largest_batch` of them
  /// @param seen what was seen in the frames' matrix, 1 or 0, in its shape: the rest, which has to
  ///        be 0 there, is no part of the machine in that frame: 0 in every reconstruction too, so
  ///        that it moves neither hidden units nor parameters. None: everything was seen
  /// @throws ShapeError, also where `seen` is given while a deviation is learnt
  void step(const Rows& rows, const CdRule& rule, const RandomKey& key, LossAccumulator& losses,
            const Matrix* seen = nullptr);

  /// Unset where mini-batches are composed.
  const std::optional<RowTile>& tile() const { return tile_; }
  /// The gradient of the last step, downhill, where the optimizer is none; for tests.
  CrbmParameters gradients();

 protected:
  /// From the data to the chain's end.
  virtual void run_chain(const Rows& rows, const CdRule& rule, const RandomKey& key);
  /// After all parameters moved.
  virtual void after_update(const CdRule& rule);

  // Composed. The first draw of hidden units is in hidden_sample_.
  void clamp_data(const Rows& rows, const RandomKey& key);
  void dynamic_biases(const Crbm& machine, const Rows& rows);
  /// From hidden_sample_ on. @param machine whose chain it is
  /// @param draw_last leaves the last hidden units' draws in hidden_sample_
  void gibbs_chain(const Crbm& machine, std::size_t count, const CdRule& rule, RandomKey key,
                   bool draw_last = false);
  /// @param particles [batch x hidden] where chains go on from and end, if they are persistent
  void fused_chain(const Rows& rows, const CdRule& rule, const RandomKey& key,
                   const Matrix* particles = nullptr, bool fresh = false);

  Crbm& crbm_;
  CdSettings settings_;
  const Matrix* seen_ = nullptr;  ///< step()'s
  std::optional<RowTile> tile_;
  Optimizer optimizer_;
  // Dynamic biases while the chain runs; the fused chain leaves data − reconstruction there.
  Matrix visible_data_, visible_, visible_bias_;  // [batch x visible]
  Matrix hidden_data_, hidden_, hidden_bias_;     // [batch x hidden]
  Matrix hidden_sample_;                          // composed

 private:
  void add_loss(std::size_t count, LossAccumulator& losses);
  void composed_update(const Rows& rows, const CdRule& rule);
  void composed_gradients(const Rows& rows);
  void fused_update(const Rows& rows, const CdRule& rule, LossAccumulator& losses);
  void pull_to_target(std::size_t count, const CdRule& rule);
  void learn_deviation(std::size_t count, float rate);

  Matrix row_losses_;                     // [1 x batch], fused
  Matrix visible_seen_;                   // [batch x visible], composed, where seen_ is
  Matrix activity_;                       // [1 x hidden], of a target
  std::optional<CrbmMatrices> gradient_;  // the optimizer's, composed
};

}  // namespace mcdbn
