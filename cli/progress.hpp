#pragma once

#include <chrono>
#include <string>

namespace mcdbn::cli {

/// One line on stderr that shows how far a long job is: rewritten in place on a terminal, a plain
/// line every few seconds elsewhere, nothing with --quiet.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// @param fraction done, 0 … 1; adds the time left by the rate so far
  /// @param once_s of the time so far that does not come again, as that of compiling kernels
  void show(const std::string& what, double fraction, double once_s = 0);
  /// For work after all that the fraction counts.
  void show(const std::string& what);
  double elapsed_s() const;

 private:
  using Clock = std::chrono::steady_clock;
  void put(const std::string& line);

  bool quiet_, terminal_;
  bool line_open_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_shown_;
};

}  // namespace mcdbn::cli
