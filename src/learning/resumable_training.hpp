#pragma once

#include "learning/checkpoints.hpp"
#include "mcdbn/learning/fine_tuning.hpp"
#include "mcdbn/learning/greedy_schedule.hpp"

namespace mcdbn {

/// Trainings that may be interrupted: as train_greedy() and fine_tune(), with checkpoints.
/// @param checkpoints what to go on from, and where to keep more; none: nothing is kept
/// @throws as these, InputError if a checkpoint is of another training; Interrupted
Mcdbn train_greedy(Device& device, Checkpoints* checkpoints, const SequenceSource& source,
                   const LearningSettings& learning, const EpochObserver& observer = {},
                   const Mcdbn* start = nullptr);
FineTuned fine_tune(Device& device, Checkpoints* checkpoints, const Mcdbn& start,
                    const SequenceSource& source, const SequenceSource* held_out,
                    const LearningSettings& settings, const SequenceLossMaker& make_loss,
                    const EpochObserver& observer = {});

}  // namespace mcdbn
