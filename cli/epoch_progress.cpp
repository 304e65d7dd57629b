#include "epoch_progress.hpp"

#include <fmt/format.h>

namespace mcdbn::cli {

EpochObserver shown_on(ProgressLine& progress) {
  return [&](const EpochReport& report) {
    progress.show(fmt::format("{} epoch {}/{}  loss {:.4f}  {:.0f} windows/s", report.stage,
                              report.epoch, report.epochs, report.loss, report.windows_per_s),
                  report.overall_progress);
    // A minute and more after a long training.
    if (report.stage == "fine-tuning" && report.overall_progress >= 1)
      progress.show("learning how sure its answers are");
  };
}

}  // namespace mcdbn::cli
