#pragma once

#include <atomic>
#include <cstddef>
#include <future>
#include <optional>

#include "base/interruption.hpp"

namespace mcdbn {

/// Calls work(i) for every i below `count`, two at a time: here and in one thread more, which an
/// interruption stops where it would stop this one. Which thread runs which is unspecified.
template <typename Work>
void on_two_threads(std::size_t count, const Work& work) {
  std::atomic<std::size_t> next = 0;
  const auto take_turns = [&] {
    for (std::size_t i = next++; i < count; i = next++) work(i);
  };
  const bool is_deferred = interruption_deferred();
  std::future<void> second = std::async(std::launch::async, [&] {
    std::optional<InterruptionDeferred> as_here;
    if (is_deferred) as_here.emplace();
    take_turns();
  });
  take_turns();
  second.get();
}

}  // namespace mcdbn
