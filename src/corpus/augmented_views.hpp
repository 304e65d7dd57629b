#pragma once

#include <memory>
#include <optional>

#include "mcdbn/corpus/training_set.hpp"

namespace mcdbn {

/// Views of the training clips (augmented_view), standardized, for fine-tuning:
/// config.augment.views of each clip, fewer where that would be more than some two hours.
/// @param clips at their own rate, as make_training_set took them
/// @param pool what new poses are made of (TrainingSet::new_poses); none: it is made
/// @param held_out a person, as the set numbers them, whose views have new poses of their own clips
/// alone, and of whose clips the others' have none
TrainingSet make_augmented_views(const ClipStore& clips, const Modalities& modalities,
                                 const CorpusSettings& settings, std::uint64_t seed,
                                 std::shared_ptr<const PosePool> pool = {},
                                 std::optional<std::size_t> held_out = {});

/// How many frames those views have together.
/// @param frames of all clips at the model's rate
double frames_of_views(double frames, const CorpusSettings& settings);

}  // namespace mcdbn
