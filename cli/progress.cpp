#include "progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace mcdbn::cli {
namespace {

constexpr auto kTerminalInterval = std::chrono::milliseconds(100);  // as fast as eyes follow
constexpr auto kPlainInterval = std::chrono::seconds(5);            // an hour is 720 lines of a log

std::string duration_text(double seconds) {
  const auto whole = std::lround(seconds);
  return whole < 60 ? fmt::format("{} s", whole)
                    : fmt::format("{} min {:02} s", whole / 60, whole % 60);
}

}  // namespace

ProgressLine::ProgressLine(bool quiet)
    : quiet_(quiet),
      terminal_(::isatty(STDERR_FILENO) == 1),
      last_shown_(start_ - kPlainInterval) {}

ProgressLine::~ProgressLine() {
  if (line_open_) std::fputc('\n', stderr);
}

double ProgressLine::elapsed_s() const {
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

void ProgressLine::show(const std::string& what, double fraction, double once_s) {
  const auto now = Clock::now();
  const bool due = now - last_shown_ >= (terminal_ ? Clock::duration(kTerminalInterval)
                                                   : Clock::duration(kPlainInterval));
  if (quiet_ || (!due && fraction < 1.0)) return;
  last_shown_ = now;
  const double worked_s = std::max(elapsed_s() - once_s, 0.0);
  const double left_s = fraction > 0 ? worked_s * (1.0 - fraction) / fraction : 0.0;
  put(fmt::format("{:3.0f} %  {}  {} left", 100.0 * fraction, what, duration_text(left_s)));
}

void ProgressLine::show(const std::string& what) {
  if (!quiet_) put(what);
}

void ProgressLine::put(const std::string& line) {
  if (terminal_)
    fmt::print(stderr, "\r\033[K{}", line);
  else
    fmt::print(stderr, "{}\n", line);
  line_open_ = terminal_;
}

}  // namespace mcdbn::cli
