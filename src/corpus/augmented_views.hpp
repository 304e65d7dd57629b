#pragma once

#include <memory>

#include "mcdbn/corpus/training_set.hpp"

namespace mcdbn {

/// Views of the training clips (augmented_view), standardized, for fine-tuning:
/// config.augment.views of each clip, fewer where that would be more than some two hours.
/// @param clips at their own rate, as make_training_set took them
/// @param pool what new poses are made of (TrainingSet::new_poses); none: it is made
TrainingSet make_augmented_views(const ClipStore& clips, const Modalities& modalities,
                                 const CorpusSettings& settings, std::uint64_t seed,
                                 std::shared_ptr<const PosePool> pool = {});

/// How many frames those views have together.
/// @param frames of all clips at the model's rate
double frames_of_views(double frames, const CorpusSettings& settings);

}  // namespace mcdbn
