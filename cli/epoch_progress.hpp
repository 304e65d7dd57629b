#pragma once

#include "mcdbn/learning/epoch_report.hpp"
#include "progress.hpp"

namespace mcdbn::cli {

/// Shows each epoch.
EpochObserver shown_on(ProgressLine& progress);

}  // namespace mcdbn::cli
