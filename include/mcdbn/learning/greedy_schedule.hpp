// The room learning: how machines are trained on sequences: contrastive divergence,
// multi-prediction, the greedy schedule (Algorithm 1), fine-tuning. It uses machines. Add here: a
// learning rule: a class beside ContrastiveDivergence, its kernels named after it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "mcdbn/learning/cd_settings.hpp"
#include "mcdbn/learning/epoch_report.hpp"
#include "mcdbn/learning/learning_settings.hpp"
#include "mcdbn/learning/sequence_source.hpp"
#include "mcdbn/machines/mcdbn.hpp"

namespace mcdbn {

/// Algorithm 1: the last modality's CDBN layer by layer (3D), those before it, then the MRBM on
/// their codes. Two modalities or more.
/// The observer may throw to stop.
/// @param start weights to start from; nothing: small random ones, of the settings' deviations
/// @throws ShapeError for one modality, or two of one name; ShapeError, InputError for sequences
///         that SynchronizedClips::check() refuses; ConfigError where the deviation of units is to
///         be learnt that were not always seen; DivergenceError naming what to lower
Mcdbn train_greedy(Device& device, const SequenceSource& source, const LearningSettings& learning,
                   const EpochObserver& observer = {}, const Mcdbn* start = nullptr);

struct TrainedCdbn {
  Cdbn cdbn;
  Sequences code;  ///< of what it was trained on
};

/// The layers that the settings specify, as wide and with as long a history each.
/// @param kind of the lowest layer's visible units
std::vector<CrbmShape> layer_shapes(std::size_t visible, const LearningSettings& learning,
                                    VisibleKind kind = VisibleKind::gaussian);

/// A CDBN layer by layer, each on the code of the one beneath. Gaussian layers learn by
/// `learning.gaussian`, binary ones by `learning.binary`.
/// @param layers from below, any width and order each: layer_shapes(), or the caller's own
/// @param first_stream of the lowest layer's random numbers; the others' follow
/// @param start weights to start from; nothing: small random ones
/// @throws ShapeError if a layer does not fit the one beneath; InputError naming the first value
///         that the lowest layer's units cannot take, its row counted over all sequences;
///         DivergenceError
TrainedCdbn train_cdbn(Device& device, Sequences visible, const std::vector<CrbmShape>& layers,
                       const LearningSettings& learning, std::uint16_t first_stream = 0,
                       const EpochObserver& observer = {}, const std::string& name = "cdbn",
                       const Cdbn* start = nullptr);

/// One layer of Algorithm 1: CD-k on every window of `visible` for settings.epochs epochs.
/// @param visible [all frames x visible units]
/// @param initial its visible_mean is taken from `visible`
/// @param stream separates this layer's random numbers from those of the others
/// @throws ShapeError if the columns are not the layer's visible units; InputError naming the first
///         value that these cannot take, its row counted over all sequences; DivergenceError naming
///         what to lower
Crbm train_crbm(Device& device, const Sequences& visible, CrbmParameters initial,
                const CdSettings& settings, const LearningSettings& learning, std::uint16_t stream,
                const EpochObserver& observer = {}, const std::string& stage = "crbm");

/// An MRBM's first weights: small random ones, and visible biases with which the mean field starts
/// near the codes' own means rather than at one half.
/// @param codes [all frames x code] of each of the shape's modalities, in its order
/// @throws ShapeError if they are of another number of modalities
MrbmParameters initial_mrbm_weights(const MrbmShape& shape, std::span<const Sequences> codes,
                                    const LearningSettings& learning);

/// The MRBM, by the settings' rule, on codes of each modality whose rows belong to the same frames,
/// the first modality's look_ahead frames later.
/// @param codes [all frames x code] of each modality, of the same clips
/// @throws ShapeError if their columns are not the MRBM's visible units, or their clips differ;
///         InputError naming the first value that its units cannot take, its row counted over all
///         sequences; DivergenceError naming what to lower
Mrbm train_mrbm(Device& device, std::span<const Sequences> codes, const MrbmParameters& initial,
                const LearningSettings& learning, std::uint16_t stream,
                const EpochObserver& observer = {});

}  // namespace mcdbn
