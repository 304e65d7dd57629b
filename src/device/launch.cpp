#include "device/launch.hpp"

#include <algorithm>

namespace mcdbn {

std::array<std::size_t, 2> local_size_for(const std::array<std::size_t, 2>& global) {
  constexpr std::size_t kItems = 64;
  const auto power_of_two_in = [](std::size_t number) {
    return number == 0 ? 1 : number & (~number + 1);
  };
  const std::size_t x = std::min(power_of_two_in(global[0]), kItems);
  return {x, std::min(power_of_two_in(global[1]), kItems / x)};
}

}  // namespace mcdbn
