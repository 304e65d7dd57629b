#include "epoch_progress.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "device/program.hpp"

namespace mcdbn::cli {

EpochObserver shown_on(ProgressLine& progress, Device& device) {
  ProgramCache& programs = device.programs();
  programs.on_long_compiling([] { spdlog::info("compiling kernels for these sizes, once"); });
  return [&, compiled_before_s = programs.compiling_s()](const EpochReport& report) {
    progress.show(fmt::format("{} epoch {}/{}  loss {:.4f}  {:.0f} windows/s", report.stage,
                              report.epoch, report.epochs, report.loss, report.windows_per_s),
                  report.overall_progress, programs.compiling_s() - compiled_before_s);
    // A minute and more after a long training.
    if (report.stage == "fine-tuning" && report.overall_progress >= 1)
      progress.show("learning how sure its answers are");
  };
}

}  // namespace mcdbn::cli
