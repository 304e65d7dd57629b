#pragma once

#include "mcdbn/training/greedy_schedule.hpp"

namespace mcdbn {

/// Views of the training clips (augmented_view), standardized, for the joint stage:
/// config.augment.views of each clip, fewer where that would be more than some two hours.
/// @param files as make_training_set read them  @throws InputError
TrainingSet make_augmented_views(const std::vector<std::filesystem::path>& files,
                                 const Modalities& modalities, const TrainingConfig& config);

/// The stage that the paper leaves out and its reference [19] has: MinVI back-propagated through
/// the whole network (joint_pass.hpp) on windows that run freely, as regeneration does. 3D from 2D
/// weighs most; the other direction stays trained. The result is the moving average of the
/// parameters. The observer may throw to stop. @throws DivergenceError saying what to lower
Mcdbn train_joint(Device& device, const Mcdbn& start, const TrainingSet& views,
                  const TrainingConfig& config, const EpochObserver& observer = {});

/// The greedy network with every weight matrix scaled to the size that random_start's has: greedy
/// weights point the right way but are so small that back-propagation moves them slowly.
Mcdbn sized_for_joint_stage(Device& device, const Mcdbn& greedy, const TrainingConfig& config);

/// A network to start the joint stage from without the greedy one: small random weights whose sizes
/// let signals through all layers.
Mcdbn random_start(Device& device, std::size_t track, std::size_t pose,
                   const TrainingConfig& config);

}  // namespace mcdbn
