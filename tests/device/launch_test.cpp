#include "device/launch.hpp"

#include <doctest/doctest.h>

#include <set>

using namespace mcdbn;

namespace {

using Group = std::array<std::size_t, 2>;

DeviceInfo that_takes(std::size_t group, std::array<std::size_t, 3> sides) {
  DeviceInfo info;
  info.largest_group = group;
  info.largest_group_sides = sides;
  return info;
}

}  // namespace

TEST_CASE("small: work-groups divide the range, hold up to 64 items, and are of few sizes") {
  const DeviceInfo large = that_takes(4096, {4096, 4096, 4096});
  std::set<Group> sizes;
  for (std::size_t x = 1; x < 300; ++x)
    for (std::size_t y = 1; y < 300; ++y) {
      const auto group = local_size_for({x, y}, large);
      const bool fits = x % group[0] == 0 && y % group[1] == 0 && group[0] * group[1] <= 64;
      if (!fits) FAIL("a range of ", x, " x ", y, " is cut into ", group[0], " x ", group[1]);
      sizes.insert(group);
    }
  CHECK(sizes.size() == 28);  // 2^i x 2^j with i + j up to 6
  CHECK(local_size_for({48, 1024}, large) == Group{16, 4});
  CHECK(local_size_for({0, 3}, large) == Group{1, 1});  // refused by the driver
}

TEST_CASE("small: work-groups hold no more items than the device takes, on no side") {
  CHECK(local_size_for({64, 64}, that_takes(1, {1, 1, 1})) == Group{1, 1});
  CHECK(local_size_for({64, 64}, that_takes(24, {24, 24, 24})) == Group{16, 1});
  CHECK(local_size_for({2, 64}, that_takes(24, {24, 24, 24})) == Group{2, 8});
  CHECK(local_size_for({8, 64}, that_takes(1024, {1024, 1, 1})) == Group{8, 1});
  CHECK(local_size_for({64, 64}, that_takes(1024, {4, 8, 1})) == Group{4, 8});
  CHECK(local_size_for({64, 64}, DeviceInfo{}) == Group{1, 1});
}
