#include "base/upper_median.hpp"

#include <doctest/doctest.h>

using namespace mcdbn;

TEST_CASE("upper median: the middle by size, the upper one of two") {
  CHECK(upper_median({7}) == 7);
  CHECK(upper_median({3, -9, 5}) == 3);
  CHECK(upper_median({4, 1, 3, 2}) == 3);
}
