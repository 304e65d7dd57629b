#pragma once

#include <optional>
#include <vector>

#include "mcdbn/learning/epoch_report.hpp"
#include "mcdbn/motion_model/model_file.hpp"
#include "mcdbn/motion_model/training_config.hpp"
#include "mcdbn/motion_model/training_sources.hpp"

namespace mcdbn {

class Checkpoints;

/// What a training run makes.
struct TrainedNetwork {
  Mcdbn network;
  std::optional<EarlyStopping> early_stopping;  ///< if one person was held out
};

/// make_training_set as a training run's settings specify.
TrainingSet make_training_set(const ClipStore& clips, const TrainingConfig& config);
/// The same with a model's features and scaling, for a training that starts from it.
TrainingSet make_training_set(const ClipStore& clips, const Modalities& modalities,
                              const TrainingConfig& config);
/// make_augmented_views likewise.
TrainingSet make_augmented_views(const ClipStore& clips, const Modalities& modalities,
                                 const TrainingConfig& config);

/// Fine-tuning with the loss on poses (PoseLoss). Of at least config.hold_out_among people one is
/// held out (person_to_hold_out) and decides when to stop.
/// @param views augmented ones  @throws DivergenceError
TrainedNetwork fine_tune_on_views(Device& device, const Mcdbn& start, const TrainingSet& views,
                                  const TrainingConfig& config, const EpochObserver& observer = {},
                                  Checkpoints* checkpoints = nullptr);

/// The greedy stages (Algorithm 1) on the clips as they are, or on augmented views of them and then
/// fine-tuning, or that alone, as config.fine_tuning specifies. The observer may throw to stop.
/// @param data of those clips (make_training_set)
/// @param checkpoints of a training that may be interrupted and go on (learning/checkpoints.hpp)
/// @param from parameters to start from instead of random ones
/// @throws DivergenceError, InputError
TrainedNetwork train_network(Device& device, const TrainingSet& data, const ClipStore& clips,
                             const TrainingConfig& config, const EpochObserver& observer = {},
                             Checkpoints* checkpoints = nullptr, const Mcdbn* from = nullptr);

}  // namespace mcdbn
