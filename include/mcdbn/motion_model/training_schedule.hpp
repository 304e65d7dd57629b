#pragma once

#include <optional>
#include <vector>

#include "mcdbn/learning/epoch_report.hpp"
#include "mcdbn/motion_model/model_file.hpp"
#include "mcdbn/motion_model/training_config.hpp"
#include "mcdbn/motion_model/training_sources.hpp"

namespace mcdbn {

/// Result of a training run.
struct TrainedNetwork {
  Mcdbn network;
  std::optional<EarlyStopping> early_stopping;  ///< if one person was held out
};

/// make_training_set as a training run's settings specify.
TrainingSet make_training_set(const ClipStore& clips, const TrainingConfig& config);
/// make_training_set() with a model's features and scaling, for a training that starts from it.
TrainingSet make_training_set(const ClipStore& clips, const Modalities& modalities,
                              const TrainingConfig& config);
/// make_augmented_views() as a training run's settings specify.
TrainingSet make_augmented_views(const ClipStore& clips, const Modalities& modalities,
                                 const TrainingConfig& config);

/// The greedy stages (Algorithm 1) on the clips as they are, or on augmented views of them and then
/// fine-tuning, or that alone, as config.fine_tuning specifies. The observer may throw to stop.
/// @param data of those clips (make_training_set)
/// @param start parameters to start from instead of random ones
/// @throws DivergenceError, InputError
TrainedNetwork train_network(Device& device, const TrainingSet& data, const ClipStore& clips,
                             const TrainingConfig& config, const EpochObserver& observer = {},
                             const Mcdbn* start = nullptr);

}  // namespace mcdbn
