#include "device/tuner.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "base/scoped_variable.hpp"
#include "base/scratch_folder.hpp"
#include "device/default_tuning.hpp"
#include "device/every_device.hpp"
#include "device/median_time.hpp"

namespace tuner_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

DeviceInfo some_cpu() {
  DeviceInfo info;
  info.is_gpu = false;
  return info;
}

DeviceInfo some_gpu() {
  DeviceInfo info;
  info.is_gpu = true;
  info.largest_group = info.largest_group_sides[0] = 1024;
  return info;
}

/// The same work for all candidates.
TunedWork all_by(const TunedTime& time_s) {
  return {time_s, time_s};
}

}  // namespace

TEST_CASE("tuner: whichever candidate is the fastest is found, on a CPU and on a GPU") {
  for (const DeviceInfo& info : {some_cpu(), some_gpu()}) {
    const Tuning usual = default_tuning(info);
    for (const Tuning& favourite : tuning_candidates(info, usual)) {
      std::vector<std::string> notices;
      CHECK(fastest_tuning(
                info, usual,
                all_by([&](const Tuning& tuning) { return tuning == favourite ? 1.0 : 2.0; }),
                [&](const std::string& notice) { notices.push_back(notice); }) == favourite);
      for (std::size_t i = 0; i < notices.size(); ++i)  // each is another
        CHECK(std::ranges::count(notices, notices[i]) == 1);
    }
  }
}

TEST_CASE("tuner: the winners of one parameter after another are put together") {
  const Tuning usual = default_tuning(some_cpu());
  std::vector<std::string> notices;
  const Tuning found =
      fastest_tuning(some_cpu(), usual, all_by([](const Tuning& tuning) {
                       // Each of these helps by itself; eight rows only beside a narrow vector.
                       double time_s = 10;
                       if (tuning.vector_width == 8) time_s -= 1;
                       if (tuning.largest_rows == 8 && tuning.vector_width == 8) time_s -= 2;
                       if (tuning.update_rows == 4) time_s -= 1;
                       return time_s;
                     }),
                     [&](const std::string& notice) { notices.push_back(notice); });
  Tuning want = usual;
  want.vector_width = want.largest_rows = 8;
  want.update_rows = 4;
  CHECK(found == want);
  CHECK(notices.size() == tuning_candidates(some_cpu(), usual).size() - 1);
  CHECK(notices.front().find("0.90 of the best so far") != std::string::npos);
}

TEST_CASE("tuner: a gain that noise could make changes nothing") {
  const auto tuned = [](double gain) {
    return fastest_tuning(some_cpu(), default_tuning(some_cpu()), all_by([=](const Tuning& tuning) {
                            return tuning.update_rows == 4 ? 1.0 - gain : 1.0;
                          }));
  };
  CHECK(tuned(0.02) == default_tuning(some_cpu()));
  CHECK(tuned(0.04).update_rows == 4);
}

TEST_CASE("tuner: two runs of five that something disturbed decide nothing") {
  int runs = 0;
  const Tuning found =
      fastest_tuning(some_cpu(), default_tuning(some_cpu()), all_by([&](const Tuning& tuning) {
                       // Each rival's five runs alternate with the best's: of the best's, two are
                       // slow.
                       const int pair = runs++ / 2 % 5;
                       return tuning == default_tuning(some_cpu()) && pair < 2 ? 2.0 : 1.0;
                     }));
  CHECK(found == default_tuning(some_cpu()));
}

TEST_CASE("tuner: products choose the parameters of products, mini-batches all others") {
  const Tuning usual = default_tuning(some_cpu());
  const int other = usual.product_columns == 1 ? 2 : 1;
  // Each kind of work likes a change that the other does not do.
  const auto likes = [&](bool columns) {
    return [=](const Tuning& tuning) {
      const bool liked = columns ? tuning.product_columns == other : tuning.update_rows == 4;
      return liked ? 1.0 : 2.0;
    };
  };
  Tuning both = usual;
  both.product_columns = other;
  both.update_rows = 4;
  CHECK(fastest_tuning(some_cpu(), usual,
                       {.products_s = likes(true), .minibatches_s = likes(false)}) == both);
  CHECK(fastest_tuning(some_cpu(), usual,
                       {.products_s = likes(false), .minibatches_s = likes(true)}) == usual);
}

TEST_CASE("tuner: where the cache cannot be written it says so; the device is tuned all the same") {
  on_every_device([](Device& device) {
    const ScratchFolder folder;
    const ScopedVariable cache("XDG_CACHE_HOME", folder.write("file", "").string());
    const Tuning usual = device.tuning(), start = default_tuning(device.info());
    const Tuning favourite = tuning_candidates(device.info(), start).back();
    const TunedTime time_s = [&](const Tuning& tuning) { return tuning == favourite ? 1.0 : 2.0; };
    CHECK_FALSE(tune(device, start, all_by(time_s), 0.0));
    Tuning found = device.tuning();
    found.clblast_from = favourite.clblast_from;
    CHECK(found == favourite);
    device.set_tuning(usual);
  });
}

TEST_CASE("median time: that of a run, however long its samples are") {
  on_every_device([](Device& device) {
    int all_runs = 0;
    const auto start = std::chrono::steady_clock::now();
    const double time_s = median_time_s(
        device, [&] { ++all_runs; }, 1e-9);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    CHECK(time_s >= 0);
    // Of a run, not of a sample of many: a median is at most twice the mean.
    CHECK(time_s * all_runs <= 2 * took.count());
    const auto runs_in = [&](double seconds) {
      int runs = 0;
      median_time_s(
          device,
          [&] {
            ++runs;
            std::this_thread::sleep_for(std::chrono::milliseconds(12));
          },
          seconds);
      return runs;
    };
    // One to see how long it is, longer than a sample here, then the samples.
    CHECK(runs_in(1e-9) == 6);
    CHECK(runs_in(0) == 1);
  });
}

}  // namespace tuner_test
