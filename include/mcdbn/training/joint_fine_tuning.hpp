#pragma once

#include <optional>

#include "mcdbn/model/model_file.hpp"
#include "mcdbn/training/greedy_schedule.hpp"

namespace mcdbn {

/// What a training run makes.
struct TrainedNetwork {
  Mcdbn network;
  std::optional<EarlyStopping> early_stopping;  ///< if one person was held out
};

/// The stage that the paper leaves out and its reference [19] has: MinVI back-propagated through
/// the whole network (joint_pass.hpp) on windows that run freely, as regeneration does. 3D from 2D
/// weighs most; the other direction stays trained. The result is the moving average of the
/// parameters: the last one or, where there are enough people to hold one out
/// (held_out_person.hpp), the last one before that person fared worse. The observer may throw to
/// stop.
/// @param views augmented ones (augmented_views.hpp)
/// @throws DivergenceError saying what to lower
TrainedNetwork train_joint(Device& device, const Mcdbn& start, const TrainingSet& views,
                           const TrainingConfig& config, const EpochObserver& observer = {});

}  // namespace mcdbn
