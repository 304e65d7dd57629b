#pragma once

#include "learning/contrastive_divergence.hpp"

namespace mcdbn {

/// Persistent contrastive divergence (Tieleman 2008): the chains of the model's side do not start
/// from the data, they go on where they were, one for each place in a mini-batch. The first
/// mini-batch's start from its data.
///
/// A CRBM is one distribution for each history: a chain of place i moves under the history of the
/// window that stands in place i of the current mini-batch. What it brings along is its hidden
/// units, from another history; k steps under the new one are all that lead it there. So more steps
/// are wanted than for an RBM, whose chains always sample the same distribution.
///
/// Fast weights (Tieleman and Hinton 2009), with a fast-rate: the chains move under parameters that
/// also learn at that rate and lose a twentieth of it in every mini-batch, so that they leave where
/// they have just been. W, a and b have fast parts; A and B, the weights of the history, have none.
///
/// Two launches a mini-batch, as for ContrastiveDivergence; with fast weights one product after the
/// other. The draws are those of ContrastiveDivergence, and one more, phase k: where the chains
/// stay.
class PersistentContrastiveDivergence : public ContrastiveDivergence {
 public:
  PersistentContrastiveDivergence(Crbm& crbm, std::size_t largest_batch,
                                  const CdSettings& settings = {},
                                  std::optional<OptimizerKind> optimizer = {});
  /// With a tile of the caller's, or without the fused kernels.
  PersistentContrastiveDivergence(Crbm& crbm, std::size_t largest_batch,
                                  std::optional<RowTile> tile, const CdSettings& settings = {},
                                  std::optional<OptimizerKind> optimizer = {});

  void visit_state(TrainingState& state) override;

  /// The chains' hidden units, 0 or 1. [batch x hidden]; more rows where the batch was filled up
  const Matrix& particles() const { return particles_; }

 protected:
  void run_chain(const Rows& rows, const CdRule& rule, const RandomKey& key) override;
  void after_update(const CdRule& rule) override;

 private:
  void composed_chain(const Rows& rows, const CdRule& rule, const RandomKey& key);

  std::size_t batch_;
  Matrix particles_;
  bool fresh_ = true;
  Matrix fast_, fast_sum_;            // [1 x floats]
  std::optional<Crbm> fast_machine_;  // of fast_sum_: parameters and their fast parts
};

}  // namespace mcdbn
