#pragma once

#include <functional>

namespace mcdbn {

/// Asks the library to stop: long work checks for this request many times a second. May be called
/// from a signal handler.
void request_interruption() noexcept;

/// Withdraws the request. For tests.
void clear_interruption() noexcept;

bool interruption_requested() noexcept;

/// @throws Interrupted if that was requested, and no InterruptionDeferred lives on this thread
void check_interruption();

/// Runs a call that may block for long on a thread of its own, and waits for its end.
/// @param call owns all that it uses: if the work is to stop, it goes on by itself
/// @throws what the call throws; Interrupted as check_interruption()
void run_interruptibly(std::function<void()> call);

/// For work that checks by itself where it can stop, and must not be stopped in between.
class InterruptionDeferred {
 public:
  InterruptionDeferred() noexcept;
  ~InterruptionDeferred();
  InterruptionDeferred(const InterruptionDeferred&) = delete;
  InterruptionDeferred& operator=(const InterruptionDeferred&) = delete;
};

/// Whether one lives on this thread: a thread that works for this one needs one of its own.
bool interruption_deferred() noexcept;

}  // namespace mcdbn
