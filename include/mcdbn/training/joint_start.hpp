#pragma once

#include "mcdbn/model/mcdbn.hpp"
#include "mcdbn/training/config.hpp"

namespace mcdbn {

/// A network for the greedy stages and the joint one to start from: small random weights whose
/// sizes let signals through all layers.
Mcdbn random_start(Device& device, std::size_t track, std::size_t pose,
                   const TrainingConfig& config);

}  // namespace mcdbn
