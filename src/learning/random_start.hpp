#pragma once

#include "mcdbn/learning/settings.hpp"
#include "mcdbn/machines/mcdbn.hpp"

namespace mcdbn {

/// A network for the greedy stages and fine-tuning to start from: small random weights whose
/// sizes let signals through all layers.
Mcdbn random_start(Device& device, std::size_t track, std::size_t pose,
                   const LearningSettings& learning);

}  // namespace mcdbn
