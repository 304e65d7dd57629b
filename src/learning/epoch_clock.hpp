#pragma once

#include <chrono>

#include "device/program.hpp"

namespace mcdbn {

/// The time that an epoch takes, without that in which its kernels are compiled: this comes once,
/// and may be a thousand times as long.
class EpochClock {
 public:
  explicit EpochClock(Device& device) : device_(device) {}

  /// Since the start or restart().
  double took_s() const {
    const std::chrono::duration<double> all = Clock::now() - begin_;
    return all.count() - (device_.programs().compiling_s() - compiled_before_s_);
  }
  void restart() {
    begin_ = Clock::now();
    compiled_before_s_ = device_.programs().compiling_s();
  }

 private:
  using Clock = std::chrono::steady_clock;

  Device& device_;
  Clock::time_point begin_ = Clock::now();
  double compiled_before_s_ = device_.programs().compiling_s();
};

}  // namespace mcdbn
