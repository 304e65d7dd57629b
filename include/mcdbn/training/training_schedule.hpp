#pragma once

#include "mcdbn/training/joint_fine_tuning.hpp"

namespace mcdbn {

/// The greedy stages (Algorithm 1) on the clips as they are, or on augmented views of them and then
/// the joint stage, or that one alone, as config.joint says.
/// @param files as make_training_set read them, for the views
/// The observer may throw to stop. @throws DivergenceError, InputError
TrainedNetwork train_network(Device& device, const TrainingSet& data,
                             const std::vector<std::filesystem::path>& files,
                             const TrainingConfig& config, const EpochObserver& observer = {});

}  // namespace mcdbn
