#pragma once

#include "learning/mrbm_chains.hpp"

namespace mcdbn {

/// Learns an MRBM's joint likelihood log p(v¹, v², …) (section III.D) by contrastive divergence
/// over all modalities at once or, with MrbmSettings::persistent, by chains that go on from one
/// mini-batch to the next (Tieleman 2008).
class JointLikelihood : public MrbmChains {
 public:
  /// @param optimizer unset: what the settings say
  JointLikelihood(Mrbm& mrbm, std::size_t batch, const MrbmSettings& settings,
                  std::optional<OptimizerKind> optimizer = {});

 protected:
  void add_gradients(const RandomKey& key, LossAccumulator& losses) override;

 private:
  Matrix weights_;  // [batch x 1]
  bool started_ = false;
  Matrix particles_;  // [batch x hidden], persistent
};

}  // namespace mcdbn
