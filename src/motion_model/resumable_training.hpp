#pragma once

#include "learning/checkpoints.hpp"
#include "mcdbn/motion_model/training_run.hpp"
#include "mcdbn/motion_model/training_schedule.hpp"

namespace mcdbn {

/// As train_network() and train_model() without checkpoints, for trainings that may be interrupted.
/// @param checkpoints what to go on from, and where to keep more; none: nothing is kept
/// @throws as these, InputError if a checkpoint is of another training; Interrupted
TrainedNetwork train_network(Device& device, Checkpoints* checkpoints, const TrainingSet& data,
                             const ClipStore& clips, const TrainingConfig& config,
                             const EpochObserver& observer = {}, const Mcdbn* start = nullptr);
TrainedRun train_model(Device& device, Checkpoints* checkpoints, const TrainingSet& data,
                       const ClipStore& clips, const TrainingConfig& config,
                       const EpochObserver& observer = {}, const Model* start = nullptr);

}  // namespace mcdbn
