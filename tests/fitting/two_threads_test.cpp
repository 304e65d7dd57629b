#include "fitting/two_threads.hpp"

#include <doctest/doctest.h>

#include <atomic>
#include <latch>
#include <vector>

#include "mcdbn/base/errors.hpp"

namespace two_threads_test {

using namespace mcdbn;

namespace {

/// How many of two threads, each at work, a request to stop would end.
int stopped_threads() {
  std::latch both_at_work(2);
  std::atomic<int> stopped = 0;
  on_two_threads(2, [&](std::size_t) {
    both_at_work.arrive_and_wait();
    try {
      check_interruption();
    } catch (const Interrupted&) {
      ++stopped;
    }
  });
  return stopped;
}

}  // namespace

TEST_CASE("two threads: each number is worked on once") {
  std::vector<std::atomic<int>> times(100);
  on_two_threads(times.size(), [&](std::size_t i) { ++times[i]; });
  for (const std::atomic<int>& one : times) CHECK(one == 1);
}

TEST_CASE("two threads: a request stops both, or neither where it is deferred") {
  CHECK(stopped_threads() == 0);
  request_interruption();
  CHECK(stopped_threads() == 2);
  {
    const InterruptionDeferred until_later;
    CHECK(stopped_threads() == 0);
  }
  CHECK_THROWS_AS(on_two_threads(8, [](std::size_t) { check_interruption(); }), Interrupted);
  clear_interruption();
}

}  // namespace two_threads_test
