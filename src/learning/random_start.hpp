#pragma once

#include "mcdbn/learning/learning_settings.hpp"
#include "mcdbn/machines/mcdbn.hpp"

namespace mcdbn {

/// A network for the greedy stages and fine-tuning to start from: small random weights whose
/// sizes let signals through all layers.
/// @param modalities their names, and the units of their lowest layers
Mcdbn random_start(Device& device, const std::vector<Modality>& modalities,
                   const LearningSettings& learning);

}  // namespace mcdbn
