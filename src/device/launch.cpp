#include "device/launch.hpp"

#include <algorithm>
#include <chrono>

#include "base/interruption.hpp"

namespace mcdbn {

void keep_pace(Device& device) {
  using Clock = std::chrono::steady_clock;
  constexpr auto kShortest = std::chrono::milliseconds(50),
                 kLongest = std::chrono::milliseconds(150);
  constexpr std::size_t kMostLaunches = 1U << 16U;
  thread_local std::size_t launches = 0, together = 1;
  thread_local Clock::time_point last = Clock::now();
  if (++launches < together) return;
  device.finish();
  const auto took = Clock::now() - last;
  if (took < kShortest) together = std::min(2 * together, kMostLaunches);
  if (took > kLongest) together = std::max<std::size_t>(1, together / 2);
  launches = 0;
  last = Clock::now();
  check_interruption();
}

std::array<std::size_t, 2> local_size_for(const std::array<std::size_t, 2>& global) {
  constexpr std::size_t kItems = 64;
  const auto power_of_two_in = [](std::size_t number) {
    return number == 0 ? 1 : number & (~number + 1);
  };
  const std::size_t x = std::min(power_of_two_in(global[0]), kItems);
  return {x, std::min(power_of_two_in(global[1]), kItems / x)};
}

}  // namespace mcdbn
