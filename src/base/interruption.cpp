#include "base/interruption.hpp"

#include <atomic>
#include <chrono>
#include <exception>
#include <future>
#include <thread>
#include <utility>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

std::atomic<bool> requested{false};
thread_local int deferred = 0;
static_assert(std::atomic<bool>::is_always_lock_free, "signal handlers write it");

}  // namespace

void request_interruption() noexcept {
  requested = true;
}

void clear_interruption() noexcept {
  requested = false;
}

bool interruption_requested() noexcept {
  return requested;
}

void check_interruption() {
  if (requested && !interruption_deferred()) throw Interrupted("interrupted");
}

void run_interruptibly(std::function<void()> call) {
  constexpr auto kLookEvery = std::chrono::milliseconds(50);
  std::promise<void> promise;
  std::future<void> end = promise.get_future();
  std::thread([call = std::move(call), promise = std::move(promise)]() mutable {
    std::exception_ptr failure;
    try {
      call();
    } catch (...) {
      failure = std::current_exception();
    }
    call = nullptr;  // its captures are freed before its end is reported
    if (failure)
      promise.set_exception(failure);
    else
      promise.set_value();
  }).detach();
  while (end.wait_for(kLookEvery) != std::future_status::ready) check_interruption();
  end.get();
}

InterruptionDeferred::InterruptionDeferred() noexcept {
  ++deferred;
}

InterruptionDeferred::~InterruptionDeferred() {
  --deferred;
}

bool interruption_deferred() noexcept {
  return deferred > 0;
}

}  // namespace mcdbn
