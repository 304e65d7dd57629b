#include "interrupt.hpp"

#include <csignal>

#include "mcdbn/base/errors.hpp"

namespace mcdbn::cli {
namespace {

volatile std::sig_atomic_t interrupted = 0;

void note_interrupt(int) {
  interrupted = 1;
}

}  // namespace

InterruptGuard::InterruptGuard() : previous_(std::signal(SIGINT, note_interrupt)) {
  interrupted = 0;
}

InterruptGuard::~InterruptGuard() {
  std::signal(SIGINT, previous_);
}

void InterruptGuard::check() const {
  if (interrupted) throw Interrupted("interrupted");
}

}  // namespace mcdbn::cli
