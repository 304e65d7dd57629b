#include "device/launch.hpp"

#include <doctest/doctest.h>

#include <set>

using namespace mcdbn;

TEST_CASE("small: work-groups divide the range, hold up to 64 items, and are of few sizes") {
  std::set<std::array<std::size_t, 2>> sizes;
  for (std::size_t x = 1; x < 300; ++x)
    for (std::size_t y = 1; y < 300; ++y) {
      const auto group = local_size_for({x, y});
      const bool fits = x % group[0] == 0 && y % group[1] == 0 && group[0] * group[1] <= 64;
      if (!fits) FAIL("a range of ", x, " x ", y, " is cut into ", group[0], " x ", group[1]);
      sizes.insert(group);
    }
  CHECK(sizes.size() == 28);  // 2^i x 2^j with i + j up to 6
  CHECK(local_size_for({48, 1024}) == std::array<std::size_t, 2>{16, 4});
  CHECK(local_size_for({0, 3}) == std::array<std::size_t, 2>{1, 1});  // refused by the driver
}
