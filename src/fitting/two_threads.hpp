#pragma once

#include <atomic>
#include <cstddef>
#include <future>

namespace mcdbn {

/// Calls work(i) for every i below `count`, two at a time: here and in one thread more. Which
/// thread runs which is unspecified.
template <typename Work>
void on_two_threads(std::size_t count, const Work& work) {
  std::atomic<std::size_t> next = 0;
  const auto take_turns = [&] {
    for (std::size_t i = next++; i < count; i = next++) work(i);
  };
  std::future<void> second = std::async(std::launch::async, take_turns);
  take_turns();
  second.get();
}

}  // namespace mcdbn
