#include "base/made_ahead.hpp"

#include <doctest/doctest.h>

#include <atomic>
#include <stdexcept>

#include "mcdbn/base/errors.hpp"

using namespace mcdbn;

TEST_CASE("results come in order whatever the threads do, and not many wait") {
  std::atomic<std::size_t> made = 0;
  std::size_t taken = 0, most_ahead = 0;
  MadeAhead<std::size_t> squares(
      [&](std::size_t number) {
        // The later, the sooner done.
        std::this_thread::sleep_for(std::chrono::microseconds(number % 5 == 0 ? 2000 : 10));
        ++made;
        return number * number;
      },
      3, 60, 4, 7);
  for (std::size_t number = 3; number < 60; ++number) {
    most_ahead = std::max(most_ahead, made - taken);
    CHECK(squares.next() == number * number);
    ++taken;
  }
  CHECK(most_ahead <= 7);
  CHECK(made == 57);
}

TEST_CASE("what making a result throws is thrown where it is taken, and those before it come") {
  MadeAhead<int> numbers(
      [](std::size_t number) {
        if (number == 2) throw std::runtime_error("two");
        return static_cast<int>(number);
      },
      0, 4, 3, 4);
  CHECK(numbers.next() == 0);
  CHECK(numbers.next() == 1);
  CHECK_THROWS_WITH(numbers.next(), "two");
  CHECK(numbers.next() == 3);
}

TEST_CASE("who waits can be interrupted; who makes goes on to the end of a result") {
  std::atomic<bool> goes_on = false;
  std::atomic<int> ends = 0;
  {
    MadeAhead<int> numbers(
        [&](std::size_t) {
          while (!goes_on) std::this_thread::sleep_for(std::chrono::milliseconds(1));
          check_interruption();  // deferred there
          return static_cast<int>(++ends);
        },
        0, 100, 1, 2);
    request_interruption();
    CHECK_THROWS_AS(numbers.next(), Interrupted);
    goes_on = true;
    {
      const InterruptionDeferred until_later;
      CHECK(numbers.next() == 1);
    }
    clear_interruption();
  }
  CHECK(ends <= 3);
}
