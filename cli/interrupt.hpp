#pragma once

namespace mcdbn::cli {

/// While one exists, SIGINT only raises a flag, so that a long job can stop cleanly.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  /// @throws Interrupted if SIGINT came
  void check() const;

 private:
  void (*previous_)(int);
};

}  // namespace mcdbn::cli
