#include "learning/minibatch.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>

#include "device/every_device.hpp"
#include "mcdbn/base/errors.hpp"

namespace minibatch_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

std::vector<std::int32_t> numbered(std::int32_t count) {
  std::vector<std::int32_t> rows;
  for (std::int32_t i = 0; i < count; ++i) rows.push_back(10 * i);
  return rows;
}

/// The rows in the order in which the schedule visits them.
std::vector<std::int32_t> visited(Device& device, const MinibatchSchedule& schedule) {
  std::vector<std::int32_t> rows(schedule.index().size());
  device.queue().enqueueReadBuffer(schedule.index().buffer(), CL_TRUE, 0,
                                   rows.size() * sizeof(std::int32_t), rows.data());
  return rows;
}

}  // namespace

TEST_CASE("small: an epoch visits every window once, in an order that the key decides") {
  on_every_device([](Device& device) {
    const auto rows = numbered(23);
    MinibatchSchedule schedule(device, rows, 5);
    CHECK(schedule.batch() == 5);
    CHECK(schedule.batch_count() == 4);
    CHECK(schedule.first_of(3) == 15);
    schedule.shuffle({.seed = 1, .step = 1});
    const auto first = visited(device, schedule);
    schedule.shuffle({.seed = 1, .step = 2});
    const auto second = visited(device, schedule);
    CHECK(first != rows);
    CHECK(first != second);
    CHECK(std::is_permutation(first.begin(), first.end(), rows.begin(), rows.end()));
    CHECK(std::is_permutation(second.begin(), second.end(), rows.begin(), rows.end()));

    MinibatchSchedule again(device, rows, 5);
    again.shuffle({.seed = 1, .step = 1});
    CHECK(visited(device, again) == first);
  });
}

TEST_CASE("small: few windows come several times, each as often") {
  on_every_device([](Device& device) {
    MinibatchSchedule schedule(device, numbered(7), 3, 4);
    CHECK(schedule.batch_count() >= 4);
    std::map<std::int32_t, int> counts;
    for (const std::int32_t row : visited(device, schedule)) ++counts[row];
    CHECK(counts.size() == 7);
    for (const auto& [row, count] : counts) CHECK(count == 2);
    CHECK(MinibatchSchedule(device, numbered(2), 100, 3).batch() == 2);
    CHECK(MinibatchSchedule(device, numbered(2), 100, 3).batch_count() == 3);
    CHECK_THROWS_AS(MinibatchSchedule(device, {}, 100, 3), ShapeError);
  });
}

}  // namespace minibatch_test
