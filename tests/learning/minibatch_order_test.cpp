// In which order the windows come, and how many of them.

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "device/every_device.hpp"
#include "learning/minibatch.hpp"

namespace minibatch_order_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

using Order = std::vector<std::int32_t>;

Order numbers(std::int32_t count) {
  Order rows(static_cast<std::size_t>(count));
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

Order order_of(Device& device, const MinibatchSchedule& schedule) {
  Order rows(schedule.index().size());
  device.queue().enqueueReadBuffer(schedule.index().buffer(), CL_TRUE, 0,
                                   rows.size() * sizeof(std::int32_t), rows.data());
  return rows;
}

Order shuffled(Device& device, std::int32_t count, const RandomKey& key) {
  MinibatchSchedule schedule(device, numbers(count), 3);
  schedule.shuffle(key);
  return order_of(device, schedule);
}

/// Pearson's χ² of counts that should all be the same.
double chi_square(const std::vector<std::size_t>& counts) {
  const double mean = static_cast<double>(std::accumulate(counts.begin(), counts.end(), 0UL)) /
                      static_cast<double>(counts.size());
  double sum = 0;
  for (const std::size_t count : counts)
    sum += (static_cast<double>(count) - mean) * (static_cast<double>(count) - mean) / mean;
  return sum;
}

}  // namespace

TEST_CASE("shuffles: every order of a few windows comes, each as often as any other") {
  on_every_device([](Device& device) {
    constexpr std::size_t kOrders = 24, kShuffles = 100 * kOrders;
    std::map<Order, std::size_t> seen;
    for (std::uint32_t i = 0; i < kShuffles; ++i)
      ++seen[shuffled(device, 4, {.seed = 5, .step = i, .stream = 3, .phase = 0x7000})];
    CHECK(seen.size() == kOrders);
    std::vector<std::size_t> counts;
    for (const auto& [order, count] : seen) counts.push_back(count);
    // 23 degrees of freedom: above 58 once in ten thousand; below 5 as seldom.
    CHECK(chi_square(counts) < 58);
    CHECK(chi_square(counts) > 5);
  });
}

TEST_CASE("shuffles: a window of many comes to every place, and its neighbours are others") {
  on_every_device([](Device& device) {
    constexpr std::int32_t kRows = 20;
    constexpr std::uint32_t kShuffles = 1000;
    std::vector<std::size_t> places(kRows), neighbours(kRows);
    for (std::uint32_t i = 0; i < kShuffles; ++i) {
      const Order order = shuffled(device, kRows, {.seed = i, .step = 1});
      const auto at =
          static_cast<std::size_t>(std::find(order.begin(), order.end(), 7) - order.begin());
      ++places[at];
      ++neighbours[static_cast<std::size_t>(order[(at + 1) % kRows])];
    }
    CHECK(chi_square(places) < 50);  // 19 degrees of freedom: above 50 once in ten thousand
    CHECK(neighbours[7] == 0);
    neighbours.erase(neighbours.begin() + 7);
    CHECK(chi_square(neighbours) < 48);  // 18
  });
}

TEST_CASE("shuffles: seed, epoch, stream and phase each give another order") {
  on_every_device([](Device& device) {
    const RandomKey key{.seed = 9, .step = 4, .stream = 2, .phase = 1};
    std::vector<RandomKey> others(5, key);
    ++others[0].seed;
    others[1].seed += 1ULL << 32;
    ++others[2].step;
    ++others[3].stream;
    ++others[4].phase;
    const Order order = shuffled(device, 30, key);
    CHECK(order == shuffled(device, 30, key));
    std::vector<Order> all{order};
    for (const RandomKey& other : others) all.push_back(shuffled(device, 30, other));
    std::sort(all.begin(), all.end());
    CHECK(std::adjacent_find(all.begin(), all.end()) == all.end());
  });
}

TEST_CASE("shuffles: what the last whole mini-batch leaves over differs from epoch to epoch") {
  on_every_device([](Device& device) {
    MinibatchSchedule schedule(device, numbers(11), 4);
    REQUIRE(schedule.batch_count() == 2);
    std::vector<int> left_over(11);
    for (std::uint32_t epoch = 1; epoch <= 60; ++epoch) {
      schedule.shuffle({.seed = 1, .step = epoch});
      const Order order = order_of(device, schedule);
      CHECK(std::is_permutation(order.begin(), order.end(), numbers(11).begin()));
      for (std::size_t i = schedule.batch() * schedule.batch_count(); i < order.size(); ++i)
        ++left_over[static_cast<std::size_t>(order[i])];
    }
    for (const int count : left_over) CHECK(count > 0);
  });
}

TEST_CASE("shuffles: rows come as often as they weigh, in any order") {
  on_every_device([](Device& device) {
    constexpr std::uint32_t kEpochs = 200;
    const std::vector<double> weights{1, 1, 0.5, 4, 3.5};
    MinibatchSchedule schedule(device, numbers(5), 2, 4, weights);
    std::vector<double> counts(5);
    std::vector<std::size_t> first(5);
    for (std::uint32_t epoch = 1; epoch <= kEpochs; ++epoch) {
      schedule.shuffle({.seed = 2, .step = epoch});
      const Order order = order_of(device, schedule);
      REQUIRE(order.size() == 10);  // as without weights
      std::vector<double> now(5);
      for (const std::int32_t row : order) now[static_cast<std::size_t>(row)] += 1;
      for (std::size_t row = 0; row < 5; ++row) {
        CHECK(std::abs(now[row] - weights[row]) < 1);  // the weights sum to 10
        counts[row] += now[row] / kEpochs;
      }
      ++first[static_cast<std::size_t>(order.front())];
    }
    // A row of weight 0.5 is there or not: four deviations of its mean are 0.14.
    for (std::size_t row = 0; row < 5; ++row) CHECK(std::abs(counts[row] - weights[row]) < 0.14);
    for (const std::size_t count : first) CHECK(count > 0);
  });
}

TEST_CASE("mini-batches: whole ones only, and no more repetitions than it takes") {
  struct Counts {
    std::int32_t rows;
    std::size_t batch, least, want_batch, want_batches, want_times;
  };
  const std::vector<Counts> table = {
      {10, 5, 1, 5, 2, 1},  {11, 5, 1, 5, 2, 1},     {14, 5, 1, 5, 2, 1}, {15, 5, 1, 5, 3, 1},
      {15, 5, 3, 5, 3, 1},  {15, 5, 4, 5, 6, 2},     {14, 5, 3, 5, 5, 2}, {7, 3, 5, 3, 7, 3},
      {3, 100, 1, 3, 1, 1}, {3, 100, 40, 3, 40, 40}, {1, 1, 1, 1, 1, 1},  {5, 1, 5, 1, 5, 1}};
  on_every_device([&](Device& device) {
    for (const Counts& counts : table) {
      INFO(counts.rows, " rows, batch ", counts.batch, ", at least ", counts.least);
      MinibatchSchedule schedule(device, numbers(counts.rows), counts.batch, counts.least);
      CHECK(schedule.batch() == counts.want_batch);
      CHECK(schedule.batch_count() == counts.want_batches);
      CHECK(order_of(device, schedule).size() ==
            counts.want_times * static_cast<std::size_t>(counts.rows));
      for (std::size_t i = 0; i < schedule.batch_count(); ++i)
        CHECK(schedule.first_of(i) == i * counts.want_batch);
    }
  });
}

}  // namespace minibatch_order_test
