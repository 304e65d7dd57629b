#include "base/interruption.hpp"

#include <atomic>
#include <chrono>
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
  if (requested && deferred == 0) throw Interrupted("interrupted");
}

void run_interruptibly(std::function<void()> call) {
  constexpr auto kLookEvery = std::chrono::milliseconds(50);
  std::packaged_task<void()> task(std::move(call));
  std::future<void> end = task.get_future();
  std::thread(std::move(task)).detach();
  while (end.wait_for(kLookEvery) != std::future_status::ready) check_interruption();
  end.get();
}

InterruptionDeferred::InterruptionDeferred() noexcept {
  ++deferred;
}

InterruptionDeferred::~InterruptionDeferred() {
  --deferred;
}

}  // namespace mcdbn
