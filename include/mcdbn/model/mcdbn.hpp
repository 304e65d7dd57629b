#pragma once

#include "mcdbn/model/cdbn.hpp"
#include "mcdbn/model/mrbm.hpp"
#include "mcdbn/model/sampling_rule.hpp"

namespace mcdbn {

/// The multimodal conditional deep belief network (section IV.A, Fig. 6): a CDBN for each modality
/// and an MRBM over their codes.
struct Mcdbn {
  Cdbn track;  ///< 2D
  Cdbn pose;   ///< 3D
  Mrbm mrbm;
  std::size_t look_ahead = 0;  ///< the 2D code of frame t + look_ahead stands for the 3D code of t
  std::size_t mean_field_steps = 10;
  SamplingRule sampling = {};
  /// The 2D CDBN itself fills in missing 2D joints. Else they are left at their mean, as a network
  /// that was trained as a whole has learnt to see them.
  bool fills_gaps = true;

  Cdbn& cdbn(Modality modality) { return modality == Modality::track ? track : pose; }
  const Cdbn& cdbn(Modality modality) const { return modality == Modality::track ? track : pose; }
};

}  // namespace mcdbn
