#pragma once

#include "device/optimizer.hpp"

namespace mcdbn {

/// @param settings of a learning rule (CdSettings, MrbmSettings)
template <typename Settings>
OptimizerKind optimizer_of(const Settings& settings) {
  return settings.adam ? OptimizerKind::adam : OptimizerKind::momentum;
}

}  // namespace mcdbn
