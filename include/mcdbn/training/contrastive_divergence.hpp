#pragma once

#include "mcdbn/device/losses.hpp"
#include "mcdbn/device/update.hpp"
#include "mcdbn/model/crbm.hpp"

namespace mcdbn {

/// What one mini-batch of CD-k does to the parameters.
struct CdRule {
  std::size_t gibbs_steps = 1;
  MomentumRule W;  ///< the biases take the same without decay
  MomentumRule A, B;
};

/// Contrastive divergence for one CRBM or RBM (Algorithm 2 with its errata: the data are clamped
/// once, then k Gibbs steps, then one update; DESIGN section 2). Hidden units are sampled,
/// reconstructions of the visible ones are means, the last hidden step keeps probabilities.
class ContrastiveDivergence {
 public:
  ContrastiveDivergence(Crbm& crbm, std::size_t largest_batch);

  /// One mini-batch: enqueues and returns. The draws are those of `key` with phase = Gibbs step.
  /// Adds the mean squared reconstruction error of a unit to `losses` slot 0.
  /// @param rows the current frames (indexed or a block), at most `largest_batch` of them
  void step(const Rows& rows, const CdRule& rule, const RandomKey& key, LossAccumulator& losses);

 private:
  void clamp_data(const Rows& rows, const RandomKey& key);
  void gibbs_chain(std::size_t count, std::size_t gibbs_steps, RandomKey key);
  void update(const Rows& rows, const CdRule& rule);

  Crbm& crbm_;
  Matrix visible_data_, visible_, visible_bias_;               // [batch x visible]
  Matrix hidden_data_, hidden_, hidden_sample_, hidden_bias_;  // [batch x hidden]
  Matrix gradient_W_, gradient_A_, gradient_B_, gradient_a_, gradient_b_;
  Matrix velocity_W_, velocity_A_, velocity_B_, velocity_a_, velocity_b_;
};

}  // namespace mcdbn
