#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "base/interruption.hpp"

namespace mcdbn {

/// Threads that the machine runs at once, eight at most.
inline std::size_t usual_threads() {
  return std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1, 8);
}

/// Results of a function for numbers that follow each other, made ahead by threads of its own and
/// handed out in order: the same whatever the threads do.
template <typename Result>
class MadeAhead {
 public:
  /// @param make several threads may call it at once
  /// @param first, end the numbers, without `end`  @param most results that wait to be taken
  MadeAhead(std::function<Result(std::size_t)> make, std::size_t first, std::size_t end,
            std::size_t threads, std::size_t most)
      : make_(std::move(make)), started_(first), taken_(first), end_(end), most_(most) {
    for (std::size_t i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
  }
  /// Waits for the results that are being made.
  ~MadeAhead() {
    {
      const std::lock_guard lock(mutex_);
      stops_ = true;
    }
    changed_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }
  MadeAhead(const MadeAhead&) = delete;
  MadeAhead& operator=(const MadeAhead&) = delete;

  /// The next one, waited for. @throws what making it threw; Interrupted as check_interruption()
  Result next() {
    constexpr auto kLookEvery = std::chrono::milliseconds(50);
    std::unique_lock lock(mutex_);
    while (!ready_.contains(taken_)) {
      check_interruption();
      changed_.wait_for(lock, kLookEvery);
    }
    Outcome outcome = std::move(ready_.extract(taken_++).mapped());
    lock.unlock();
    changed_.notify_all();
    if (outcome.error) std::rethrow_exception(outcome.error);
    return std::move(*outcome.result);
  }

 private:
  struct Outcome {
    std::optional<Result> result;
    std::exception_ptr error;
  };

  void work() {
    // The caller of next() decides where to stop.
    const InterruptionDeferred deferred;
    std::unique_lock lock(mutex_);
    while (true) {
      changed_.wait(lock,
                    [this] { return stops_ || started_ == end_ || started_ < taken_ + most_; });
      if (stops_ || started_ == end_) return;
      const std::size_t number = started_++;
      lock.unlock();
      Outcome outcome;
      try {
        outcome.result = make_(number);
      } catch (...) {
        outcome.error = std::current_exception();
      }
      lock.lock();
      ready_.emplace(number, std::move(outcome));
      changed_.notify_all();
    }
  }

  std::function<Result(std::size_t)> make_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::size_t, Outcome> ready_;
  std::size_t started_, taken_, end_, most_;
  bool stops_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace mcdbn
