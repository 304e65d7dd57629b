#pragma once

#include <functional>
#include <string>
#include <vector>

#include "learning/checkpoints.hpp"
#include "mcdbn/motion_model/training_schedule.hpp"

namespace mcdbn {

/// The person who decides when fine-tuning stops.
struct HeldOutPerson {
  const TrainingSet& views;
  std::vector<std::string> clips;  ///< by file name: all, also where the views are of some
};

/// Fine-tuning with the loss on poses (PoseLoss), and how far off the answers are.
/// @param checkpoints what to go on from, and where to keep more; none: nothing is kept
/// @param source to learn from
/// @param held_out nullptr: fine-tuning runs to the end
/// @param before_deviation is called before the answers' deviation is learnt from the source
/// @throws DivergenceError
TrainedNetwork fine_tune_on_poses(Device& device, Checkpoints* checkpoints, const Mcdbn& start,
                                  const SequenceSource& source, const HeldOutPerson* held_out,
                                  const Modalities& modalities, const TrainingConfig& config,
                                  const EpochObserver& observer = {},
                                  const std::function<void()>& before_deviation = {});

}  // namespace mcdbn
