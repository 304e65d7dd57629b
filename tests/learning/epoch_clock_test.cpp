// The speed of a training leaves out the time in which kernels are compiled.

#include "learning/epoch_clock.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

#include "device/every_device.hpp"
#include "mcdbn/learning/machine_fit.hpp"

namespace epoch_clock_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

using Clock = std::chrono::steady_clock;

double since_s(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

void sleep_s(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

}  // namespace

TEST_CASE("an epoch's time is without what was compiled in it, and what was compiled before") {
  on_every_device([](Device& device) {
    device.programs().count_compiling(100);
    const auto begin = Clock::now();
    EpochClock clock(device);
    sleep_s(0.03);
    device.programs().count_compiling(0.02);
    const double first_s = clock.took_s(), with_compiling_s = since_s(begin);
    CHECK(first_s >= 0.01 - 1e-9);
    CHECK(first_s <= with_compiling_s - 0.02 + 1e-9);
    device.programs().count_compiling(100);
    const auto again = Clock::now();
    clock.restart();
    sleep_s(0.01);
    const double took_s = clock.took_s(), all_s = since_s(again);
    CHECK(took_s >= 0.01);
    constexpr double kRounding_s = 1e-9;  // of sums of hundreds of seconds
    CHECK(took_s <= all_s + kRounding_s);
  });
}

TEST_CASE("the first epoch's speed is without the kernels that it compiles") {
  constexpr std::size_t kRows = 100;
  on_every_device([](Device& open) {
    Device device(open.info());  // which has compiled nothing
    MachineSettings settings;
    settings.batch = 10;
    settings.binary.epochs = 2;
    const MatrixF bits = (random_matrix(kRows, 20, 1).array() > 0).cast<float>();
    const Sequences data = Sequences::from_host(device, {bits});
    const auto begin = Clock::now();
    const double compiled_before_s = device.programs().compiling_s();
    std::vector<EpochReport> reports;
    double worked_s = 0;
    fit_stack(device, data, VisibleKind::binary, {{8, 0}}, settings,
              [&](const EpochReport& report) {
                if (reports.empty())
                  worked_s = since_s(begin) - (device.programs().compiling_s() - compiled_before_s);
                reports.push_back(report);
              });
    REQUIRE(reports.size() == 2);
    // All the work until then, but for what was compiled, holds that of the epoch.
    CHECK(reports.front().windows_per_s >= kRows / worked_s);
  });
}

TEST_CASE("the speed of an epoch with a single mini-batch is without compiling alone") {
  constexpr std::size_t kRows = 2000;
  on_every_device([](Device& open) {
    Device device(open.info());  // which has compiled nothing
    MachineSettings settings;
    settings.batch = kRows;
    settings.binary.gibbs_steps = 30;
    settings.binary.epochs = 4;
    const MatrixF bits = (random_matrix(kRows, 64, 1).array() > 0).cast<float>();
    std::vector<double> speeds;
    fit_stack(device, Sequences::from_host(device, {bits}), VisibleKind::binary, {{64, 0}},
              settings, [&](const EpochReport& report) { speeds.push_back(report.windows_per_s); });
    REQUIRE(speeds.size() == 4);
    CHECK(speeds[0] < 4 * std::max({speeds[1], speeds[2], speeds[3]}));
  });
}

}  // namespace epoch_clock_test
