#pragma once

#include <optional>

#include "mcdbn/learning/epoch_report.hpp"
#include "mcdbn/learning/learning_settings.hpp"
#include "mcdbn/learning/sequence_loss.hpp"
#include "mcdbn/learning/sequence_source.hpp"
#include "mcdbn/machines/mcdbn.hpp"

namespace mcdbn {

/// The mini-batches after which the parameters that were kept stood, and their loss on the clips
/// held out.
struct KeptStep {
  std::size_t steps = 0;
  double loss = 0;
};

/// Result of fine-tuning.
struct FineTuned {
  Mcdbn network;
  std::optional<KeptStep> kept;  ///< if clips were held out
};

/// The stage that the paper leaves out and its reference [19] has: MinVI back-propagated through
/// the whole network (unrolled_pass.hpp) on windows that run freely, as regeneration does. The last
/// modality from the others (3D from 2D) weighs most; the other directions stay trained, by what of
/// their modality was seen (ModalityClips::seen; the last one's loss counts everything). The result
/// is the moving average of the parameters: the last one or, where clips are held out, the last one
/// before those fared worse. The observer may throw to stop.
/// @param held_out sequences that are not learnt from and decide when to stop, or none
/// @param make_loss of the last modality
/// @throws ConfigError if the settings' look-ahead is not the network's; ShapeError, InputError for
///         sequences that SynchronizedClips::check() refuses or that do not fit the network; those
///         that come by renew() are not checked. DivergenceError naming what to lower
FineTuned fine_tune(Device& device, const Mcdbn& start, const SequenceSource& source,
                    const SequenceSource* held_out, const LearningSettings& settings,
                    const SequenceLossMaker& make_loss, const EpochObserver& observer = {});

}  // namespace mcdbn
