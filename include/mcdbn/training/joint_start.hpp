#pragma once

#include "mcdbn/model/mcdbn.hpp"
#include "mcdbn/training/config.hpp"

namespace mcdbn {

/// The greedy network with every weight matrix scaled to the size that random_start's has: greedy
/// weights point the right way but are so small that back-propagation moves them slowly.
Mcdbn sized_for_joint_stage(Device& device, const Mcdbn& greedy, const TrainingConfig& config);

/// A network to start the joint stage from without the greedy one: small random weights whose sizes
/// let signals through all layers.
Mcdbn random_start(Device& device, std::size_t track, std::size_t pose,
                   const TrainingConfig& config);

}  // namespace mcdbn
