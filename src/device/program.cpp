#include "device/program.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <utility>

#include "base/interruption.hpp"
#include "base/user_cache.hpp"
#include "device/embedded_kernels.hpp"
#include "device/opencl_errors.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

namespace fs = std::filesystem;

std::string kernel_file_text(const std::string& file) {
  if (const char* folder = std::getenv("MCDBN_KERNEL_DIR")) {
    std::ifstream stream(fs::path(folder) / file, std::ios::binary);
    if (!stream)
      throw DeviceError(fmt::format("{}/{}: no such kernel file (MCDBN_KERNEL_DIR)", folder, file));
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
  }
  const auto found = embedded_kernels().find(file);
  if (found == embedded_kernels().end()) throw DeviceError("no embedded kernel file " + file);
  return found->second;
}

std::string options_of(const Defines& defines) {
  // -w: what compilers in drivers warn of they write on standard error, among our messages.
  std::string options = "-cl-std=CL1.2 -w";
  for (const auto& [name, value] : defines) options += fmt::format(" -D{}={}", name, value.text);
  // For the tests that must also pass unoptimised.
  if (const char* extra = std::getenv("MCDBN_BUILD_OPTIONS")) options += fmt::format(" {}", extra);
  return options;
}

/// Key of a kernel in the cache. It is needed at every launch: building the compiler's options
/// there would take longer than many a launch does.
std::string key_of(const std::string& file, const std::string& name, const Defines& defines) {
  std::string key;
  key.reserve(256);
  key.append(file).append(1, ' ').append(name);
  for (const auto& [define, value] : defines)
    key.append(1, ' ').append(define).append(1, '=').append(value.text);
  return key;
}

/// PoCL keeps what it compiles, and asked for a binary it compiles every kernel of the program once
/// more, for no work-group size in particular: half of all the time that a first start took.
bool driver_keeps_programs(const cl::Device& device) {
  const cl::Platform platform(device.getInfo<CL_DEVICE_PLATFORM>());
  return platform.getInfo<CL_PLATFORM_NAME>() == "Portable Computing Language";
}

/// Where the whole log of a failed build can be read, a file of its own; empty if it cannot be
/// kept.
std::string kept_log(const std::string& log) {
  std::error_code error;
  std::string path = (fs::temp_directory_path(error) / "mcdbn-cl-build-XXXXXX").string();
  const int file = error ? -1 : ::mkstemp(path.data());
  if (file < 0) return {};
  ::close(file);
  std::ofstream stream(path, std::ios::binary);
  stream << log;
  return stream.flush() ? path : std::string();
}

bool is_blank(const std::string& text) {
  return text.find_first_not_of(" \t\r\n") == std::string::npos;
}

bool names_error(const std::string& line) {
  return line.find("error") != std::string::npos;
}

/// What went wrong in a line: the first of the log that names an error.
std::string build_failure(const std::string& log, const std::string& options) {
  constexpr const char* kIsThereRoom =
      "is there room where it keeps what it builds (PoCL: $POCL_CACHE_DIR, else ~/.cache/pocl)?";
  if (is_blank(log))
    return fmt::format("building kernels with {}: the OpenCL driver gives no reason; {}", options,
                       kIsThereRoom);
  std::istringstream lines(log);
  std::string line, first;
  while (std::getline(lines, line) && !names_error(line))
    if (is_blank(first)) first = line;
  const std::string path = kept_log(log),
                    what = names_error(line)
                               ? line
                               : fmt::format("the OpenCL driver reports only '{}'; {}", first,
                                             kIsThereRoom);
  return fmt::format("building kernels with {}: {}{}", options, what,
                     path.empty() ? "" : fmt::format(" (the whole log: {})", path));
}

}  // namespace

std::string kernel_source(const std::string& file) {
  std::istringstream lines(kernel_file_text(file));
  std::string text, line;
  const std::string directive = "#include \"";
  while (std::getline(lines, line)) {
    if (line.starts_with(directive))
      text += kernel_source(line.substr(directive.size(), line.rfind('"') - directive.size()));
    else
      text += line;
    text += '\n';
  }
  return text;
}

ProgramCache::ProgramCache(cl::Context context, cl::Device device)
    : context_(std::move(context)), device_(std::move(device)) {
  keeps_binaries_ = !driver_keeps_programs(device_);
  device_name_ = device_.getInfo<CL_DEVICE_NAME>();
  device_key_ = device_name_ + '|' + device_.getInfo<CL_DEVICE_VENDOR>() + '|' +
                device_.getInfo<CL_DRIVER_VERSION>() + '|' + device_.getInfo<CL_DEVICE_VERSION>();
}

cl::Kernel& ProgramCache::kernel(const std::string& file, const std::string& name,
                                 const Defines& defines) {
  std::string key = key_of(file, name, defines);
  if (unroll_ > 1) key.append(" UNROLL=").append(std::to_string(unroll_));
  auto found = kernels_.find(key);
  if (found == kernels_.end()) {
    try {
      found = kernels_.emplace(key, cl::Kernel(program(file, defines), name.c_str())).first;
    } catch (const cl::Error& error) {
      throw device_error(device_name_, fmt::format("kernel {} in {}", name, file), error);
    }
  }
  return found->second;
}

cl::Program& ProgramCache::program(const std::string& file, Defines defines) {
  if (unroll_ > 1) defines["UNROLL"] = unroll_;
  const std::string options = options_of(defines);
  const std::string key = file + ' ' + options;
  auto found = programs_.find(key);
  if (found == programs_.end()) {
    const auto begin = std::chrono::steady_clock::now();
    found = programs_.emplace(key, build(kernel_source(file), options)).first;
    count_compiling(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  return found->second;
}

bool ProgramCache::is_first_launch(const cl::Kernel& kernel,
                                   const std::array<std::size_t, 2>& group) {
  return launched_.emplace(kernel(), group).second;
}

void ProgramCache::count_compiling(double seconds) {
  compiling_s_ += seconds;
  if (notice_ && compiling_s_ >= notice_at_s_) std::exchange(notice_, nullptr)();
}

void ProgramCache::on_long_compiling(std::function<void()> notice) {
  constexpr double kLong_s = 1;
  notice_ = std::move(notice);
  notice_at_s_ = compiling_s_ + kLong_s;
}

cl::Program ProgramCache::build(const std::string& source, const std::string& options) {
  if (!keeps_binaries_) return built_from_source(source, options);
  const std::string key = device_key_ + '\n' + options + '\n' + source;
  if (const auto binary = read_cache_entry("program", key)) {
    try {
      cl::Program program(context_, {device_}, {{binary->begin(), binary->end()}});
      program.build(options.c_str());
      return program;
    } catch (const cl::Error&) {
      // stale or corrupt: built anew below, which overwrites it
    }
  }
  cl::Program program = built_from_source(source, options);
  const auto binaries = program.getInfo<CL_PROGRAM_BINARIES>();
  if (!binaries.empty() && !binaries[0].empty())
    write_cache_entry("program", key, std::string(binaries[0].begin(), binaries[0].end()));
  return program;
}

cl::Program ProgramCache::built_from_source(const std::string& source, const std::string& options) {
  cl::Program program(context_, source);
  auto log = log_of_failed_build(program, options);
  if (log && !names_error(*log)) {
    // PoCL may fail so where two processes build the same program at once.
    program = cl::Program(context_, source);
    log = log_of_failed_build(program, options);
  }
  if (log) throw DeviceError(build_failure(*log, options), DeviceError::Kind::refused);
  return program;
}

std::optional<std::string> ProgramCache::log_of_failed_build(const cl::Program& program,
                                                             const std::string& options) const {
  // Not cl::Program::build, which asks for the log, and fails at that, whatever the failure was.
  const auto code = std::make_shared<cl_int>(CL_SUCCESS);
  run_interruptibly(
      [=] { *code = ::clBuildProgram(program(), 0, nullptr, options.c_str(), nullptr, nullptr); });
  if (*code == CL_SUCCESS) return std::nullopt;
  if (*code != CL_BUILD_PROGRAM_FAILURE) throw cl::Error(*code, "clBuildProgram");
  try {
    return program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device_);
  } catch (const cl::Error&) {
    return std::string();  // as from a driver that gives no reason
  }
}

}  // namespace mcdbn
