#include "signals.hpp"

#include <signal.h>  // NOLINT: sigprocmask and sigwait are POSIX
#include <unistd.h>

#include <thread>

#include "base/interruption.hpp"

namespace mcdbn::cli {
namespace {

sigset_t stop_signals() {
  sigset_t signals;
  ::sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM}) ::sigaddset(&signals, signal);
  return signals;
}

/// For every thread that will be: OpenCL drivers built on LLVM set handlers of their own while they
/// compile, and such a handler removes the files that are being written.
void block_signals(int, char**, char**) {
  const sigset_t signals = stop_signals();
  ::sigprocmask(SIG_BLOCK, &signals, nullptr);
}

/// Called before any library is initialized: OpenBLAS starts its threads there, and a signal that
/// all others block would go to one of them.
[[gnu::section(".preinit_array"), gnu::used]] void (*const kBlockFirst)(int, char**,
                                                                        char**) = block_signals;

}  // namespace

void start_signal_thread(int exit_code) {
  std::thread([exit_code] {
    const sigset_t signals = stop_signals();
    int signal = 0;
    while (::sigwait(&signals, &signal) == 0) {
      if (interruption_requested()) ::_exit(exit_code);
      request_interruption();
    }
  }).detach();
}

}  // namespace mcdbn::cli
