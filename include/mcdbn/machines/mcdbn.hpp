// The room machines: RBM, CRBM, CDBN, MRBM and MCDBN on plain matrices: parameters, inference,
// regeneration. It uses device. Add here: a machine: its parameters on the host, its class on the
// device (crbm.hpp shows the pattern).
#pragma once

#include <cstddef>
#include <optional>

#include "mcdbn/machines/answer_deviation.hpp"
#include "mcdbn/machines/cdbn.hpp"
#include "mcdbn/machines/mrbm.hpp"

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
  /// In the MRBM's chain one random number per unit for the whole sample, not for each frame, and
  /// concrete draws, σ(logit p + logit u): a sample is one person throughout and does not shake.
  bool steady = false;
  double scale = 1.0;  ///< what temperature 1 stands for (calibrated_sampling)
  /// A single answer is drawn too, at temperature 1, unless another is asked for.
  bool sampled = false;
};

/// The multimodal conditional deep belief network (section IV.A, Fig. 6): a CDBN for each modality
/// and an MRBM over their codes.
struct Mcdbn {
  std::vector<Cdbn> cdbns;  ///< of each modality of the MRBM, in its order
  Mrbm mrbm;
  /// The MRBM pairs the first modality's code of frame t + look_ahead with the other modalities'
  /// codes of frame t.
  std::size_t look_ahead = 0;
  std::size_t mean_field_steps = 10;
  SamplingRule sampling = {};
  /// The CDBN itself fills in missing values of what is present. Else they are 0, the mean of
  /// standardized values, as a network that was trained as a whole has learnt to see them.
  bool fills_gaps = true;
  /// Deviation of the last modality given the others; unset where it was not learnt.
  std::optional<AnswerDeviation> deviation = {};

  std::size_t modality_count() const { return cdbns.size(); }
  const Modality& modality(std::size_t m) const { return mrbm.shape().modalities[m]; }
  /// Number of frames by which codes of modality m are later than the others' that they belong to.
  std::size_t ahead(std::size_t m) const { return m == 0 ? look_ahead : 0; }
};

}  // namespace mcdbn
