#pragma once

#include "mcdbn/device/device.hpp"
#include "mcdbn/learning/epoch_report.hpp"
#include "progress.hpp"

namespace mcdbn::cli {

/// Shows each epoch, and what follows the last one of fine-tuning. A message reports that kernels
/// are compiled if that takes longer than a second; this time is left out of the time to come.
EpochObserver shown_on(ProgressLine& progress, Device& device);

}  // namespace mcdbn::cli
