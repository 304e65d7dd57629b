#pragma once

#include "device/row_tile.hpp"
#include "learning/mrbm_chains.hpp"

namespace mcdbn {

/// Learns an MRBM's joint likelihood log p(v¹, v², …) (section III.D) by contrastive divergence
/// over all modalities at once or, with MrbmSettings::persistent, by chains that go on from one
/// mini-batch to the next (Tieleman 2008).
///
/// A mini-batch is gathered, then taken in two launches (joint_likelihood.cl,
/// joint_likelihood_update.cl) where a row of all modalities fits the device's local memory, else
/// in one product after another; both draw the same numbers.
class JointLikelihood : public MrbmChains {
 public:
  /// @param optimizer unset: as the settings specify
  JointLikelihood(Mrbm& mrbm, std::size_t batch, const MrbmSettings& settings,
                  std::optional<OptimizerKind> optimizer = {});
  /// With a tile of the caller's, or without the fused kernels.
  JointLikelihood(Mrbm& mrbm, std::size_t batch, std::optional<RowTile> tile,
                  const MrbmSettings& settings, std::optional<OptimizerKind> optimizer = {});

  /// Unset where mini-batches are composed.
  const std::optional<RowTile>& tile() const { return tile_; }

  void visit_state(TrainingState& state) override;

 protected:
  void run_minibatch(std::span<const Rows> visible, const LearningStep& step,
                     LossAccumulator& losses) override;
  void add_gradients(const RandomKey& key, LossAccumulator& losses) override;

 private:
  void make_stacks();
  void fused_chain(const RandomKey& key);
  void fused_update(const UpdateRule& rule, LossAccumulator& losses);
  Defines fused_defines() const;

  std::optional<RowTile> tile_;
  std::size_t block_;  ///< rows: the batch, or whole blocks
  bool started_ = false;
  Matrix particles_;  // [block x hidden], persistent
  Matrix weights_;    // [batch x 1], composed
  // Stacks of all modalities [1 x floats] as joint_likelihood.cl has them, fused.
  Matrix codes_, stacked_visible_;
  Matrix row_losses_;  // [1 x modalities·block], fused
};

}  // namespace mcdbn
