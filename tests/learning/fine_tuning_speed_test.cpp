// The speed that fine-tuning reports is that of the mini-batches since the report before.

#include <doctest/doctest.h>

#include <chrono>
#include <thread>

#include "base/scratch_folder.hpp"
#include "learning/resumable_training.hpp"
#include "learning/small_network.hpp"
#include "learning/squared_loss.hpp"

namespace fine_tuning_speed_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr double kBatch_s = 0.02;  ///< that a mini-batch takes at least
constexpr std::size_t kWindows = 4;

struct Killed {};

/// Whose every mini-batch takes a while to come.
class SlowSource : public MatrixSource {
 public:
  using MatrixSource::MatrixSource;
  /// @throws Killed in the mini-batch that was named
  bool renew(std::size_t step) const override {
    std::this_thread::sleep_for(std::chrono::duration<double>(kBatch_s));
    if (step == killed_in) throw Killed{};
    return false;
  }

  std::optional<std::size_t> killed_in = {};
};

std::vector<EpochReport> reports_of(Device& device, const SlowSource& source,
                                    Checkpoints* checkpoints) {
  LearningSettings settings;
  settings.look_ahead = 0;
  settings.fine_tuning.steps = 27;
  settings.fine_tuning.windows = kWindows;
  settings.fine_tuning.window_frames = 4;
  settings.fine_tuning.settle_frames = 1;
  std::vector<EpochReport> reports;
  const Mcdbn start =
      on_device(device, random_network({3, 5}, {{{{4, 1}}, {{6, 1}}}}, 4, 100), 0, 2);
  fine_tune(
      device, checkpoints, start, source, nullptr, settings,
      [](Device& with, const SequenceWindows& windows) {
        return std::make_unique<SquaredLoss>(with, windows, 1.0);
      },
      [&](const EpochReport& report) { reports.push_back(report); });
  return reports;
}

void check_speeds(const std::vector<EpochReport>& reports) {
  REQUIRE(reports.size() == 2);
  CHECK(reports[0].epoch == 25);
  CHECK(reports[1].epoch == 27);
  for (const EpochReport& report : reports) {
    CHECK(report.windows_per_s > 0);
    CHECK(report.windows_per_s <= kWindows / kBatch_s);
  }
}

}  // namespace

TEST_CASE(
    "fine-tuning's speed counts the mini-batches of the last report, and after a resumption") {
  SlowSource source({{"track", {random_matrix(30, 3, 1)}}, {"pose", {random_matrix(30, 5, 2)}}});
  on_every_device([&](Device& device) {
    check_speeds(reports_of(device, source, nullptr));

    // Killed in the 25th mini-batch it goes on there: one before the first report.
    const ScratchFolder folder;
    Checkpoints::Options options;
    options.folder = folder / "";
    source.killed_in = 24;
    Checkpoints killed(options);
    CHECK_THROWS_AS(reports_of(device, source, &killed), Killed);
    source.killed_in.reset();
    Checkpoints resumed(options);
    check_speeds(reports_of(device, source, &resumed));
  });
}

}  // namespace fine_tuning_speed_test
