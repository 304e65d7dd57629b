#pragma once

#include "mcdbn/learning/epoch_report.hpp"
#include "progress.hpp"

namespace mcdbn::cli {

/// Shows each epoch, and what follows the last one of fine-tuning.
EpochObserver shown_on(ProgressLine& progress);

}  // namespace mcdbn::cli
