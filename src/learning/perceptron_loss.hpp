#pragma once

#include "learning/mrbm_chains.hpp"

namespace mcdbn {

/// MinVI by CD-PercLoss (Mnih, Larochelle and Hinton 2011; reference [49] of the paper, section
/// III.D): for each modality a chain starts from the data with all others clamped, and where it
/// ends at a lower free energy than the data's, max(0, F(data) − F(end)) is minimized; rows whose
/// data already lie lower contribute nothing. With MrbmSettings::sample_visible the codes of the
/// data are drawn, too: F is concave in a unit, so that what lies between 0 and 1 is lowest
/// nowhere.
class PerceptronLoss : public MrbmChains {
 public:
  /// @param optimizer unset: as the settings specify
  PerceptronLoss(Mrbm& mrbm, std::size_t batch, const MrbmSettings& settings,
                 std::optional<OptimizerKind> optimizer = {});

 protected:
  void add_gradients(const RandomKey& key, LossAccumulator& losses) override;

 private:
  void draw_data(const RandomKey& key);

  Matrix weights_, data_energy_, end_energy_;  // [batch x 1]
};

}  // namespace mcdbn
