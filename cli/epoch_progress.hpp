#pragma once

#include "interrupt.hpp"
#include "mcdbn/learning/epoch_report.hpp"
#include "progress.hpp"

namespace mcdbn::cli {

/// Shows each epoch, and stops the training on SIGINT.
EpochObserver shown_on(ProgressLine& progress, const InterruptGuard& interrupt);

}  // namespace mcdbn::cli
