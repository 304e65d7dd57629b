#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "mcdbn/device/device.hpp"

namespace mcdbn {

/// The text of one kernel file with its `#include "x.clh"` lines replaced by those files: from the
/// folder MCDBN_KERNEL_DIR if that is set, else as embedded. @throws DeviceError if there is none
std::string kernel_source(const std::string& file);

/// A number or a word.
struct DefineValue {
  DefineValue(int number = 0) : text(std::to_string(number)) {}  // NOLINT: numbers are values
  DefineValue(const char* word) : text(word) {}                  // NOLINT: words too
  std::string text;
};

/// Compile-time settings of a kernel file: -D NAME=VALUE each.
using Defines = std::map<std::string, DefineValue>;

/// Programs built for one device, kept in memory and as binaries in the user's cache folder
/// ($XDG_CACHE_HOME/mcdbn-cl or ~/.cache/mcdbn-cl), keyed by device, driver, source and options;
/// PoCL's are left to its own cache. A binary that does not load is rebuilt silently; an unwritable
/// folder only costs time.
class ProgramCache {
 public:
  ProgramCache(cl::Context context, cl::Device device);

  /// Sets the unrolling of every kernel that is built from here on (types.clh).
  void set_unroll(int rounds) { unroll_ = rounds; }

  /// @throws DeviceError with the build log
  cl::Kernel& kernel(const std::string& file, const std::string& name, const Defines& defines = {});

  /// Whether the kernel was not launched before with work-groups of this size; from now on it was.
  /// Some drivers compile a kernel only then, PoCL most of it and on threads of its own.
  bool is_first_launch(const cl::Kernel& kernel, const std::array<std::size_t, 2>& group);
  /// Seconds that compiling has taken so far: programs that were built, and first launches without
  /// the kernels' own runs.
  double compiling_s() const { return compiling_s_; }
  void count_compiling(double seconds);
  /// @param notice is called once, when compiling has taken a second from here on
  void on_long_compiling(std::function<void()> notice);

 private:
  cl::Program& program(const std::string& file, Defines defines);
  cl::Program build(const std::string& source, const std::string& options);
  cl::Program built_from_source(const std::string& source, const std::string& options);
  /// Nothing if the build goes well. @throws cl::Error if it fails otherwise than by its source
  std::optional<std::string> log_of_failed_build(const cl::Program& program,
                                                 const std::string& options) const;

  cl::Context context_;
  cl::Device device_;
  std::string device_name_, device_key_;
  bool keeps_binaries_;
  int unroll_ = 1;
  std::map<std::string, cl::Program> programs_;
  std::map<std::string, cl::Kernel> kernels_;
  std::set<std::pair<cl_kernel, std::array<std::size_t, 2>>> launched_;
  double compiling_s_ = 0, notice_at_s_ = 0;
  std::function<void()> notice_;
};

}  // namespace mcdbn
