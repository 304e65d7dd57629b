#pragma once

#include <cstddef>

namespace mcdbn {

/// How variations of an answer are drawn above temperature 0.
struct SamplingRule {
  /// k of Algorithm 5 in the decoder's top layer, 0: mean field. Table 2 has 3, but only the first
  /// step starts from the code: with a greedy network the error of samples at temperature 0.5 on
  /// held-out CMU walks is 53 mm with k = 1 and 130 mm with k = 2.
  std::size_t gibbs_steps = 1;
  /// k of the MRBM's own sampled chain, each sample's for itself: then samples differ in the 3D
  /// code that is inferred, too. 0: mean field, one code for all samples.
  std::size_t mrbm_gibbs_steps = 0;
  /// The chain's units draw once a sample, not once a frame, and concretely: a sample is one person
  /// throughout and does not shake.
  bool steady = false;
  double scale = 1.0;  ///< what temperature 1 stands for (calibrated_sampling)
};

}  // namespace mcdbn
