#include "run_program.hpp"

#include <fmt/ranges.h>
#include <spdlog/cfg/env.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <memory>
#include <new>
#include <opencv2/core/utils/logger.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "base/output_file.hpp"
#include "base/shown.hpp"
#include "mcdbn/base/errors.hpp"
#include "setting_flags.hpp"
#include "signals.hpp"
#include "standard_streams.hpp"

namespace mcdbn::cli {
namespace {

enum ExitCode {
  kOk = 0,
  kFailure = 1,
  kUsage = 2,
  kBadInput = 3,
  kNoDevice = 4,
  kInterrupted = 130
};

constexpr const char* kDescription =
    "Trains multimodal conditional deep belief networks on motion capture and regenerates 3D "
    "motion\n"
    "from the 2D joint tracks of one camera, on any OpenCL device.";

constexpr const char* kExitCodes =
    "Exit codes: 0 ok, 1 failure, 2 usage or configuration, 3 bad input, 4 no device or one that\n"
    "failed, 130 interrupted.";

/// Lines by the pattern, without control characters for a terminal: names in messages come out of
/// files.
class PrintableLines : public spdlog::formatter {
 public:
  void format(const spdlog::details::log_msg& message, spdlog::memory_buf_t& line) override {
    constexpr std::size_t kLongest = 4000;  // names may be of any length, too
    spdlog::details::log_msg clean = message;
    const std::string_view all(message.payload.data(), message.payload.size());
    const std::string text =
        printable(all.substr(0, kLongest)) + (all.size() > kLongest ? "..." : "");
    clean.payload = text;
    pattern_.format(clean, line);
  }
  std::unique_ptr<spdlog::formatter> clone() const override {
    return std::make_unique<PrintableLines>();
  }

 private:
  spdlog::pattern_formatter pattern_{"mcdbn-cl: %l: %v"};
};

/// People read stderr, programs read stdout: all messages go to stderr as plain lines.
/// SPDLOG_LEVEL=debug shows more.
void set_up_messages() {
  spdlog::set_default_logger(spdlog::stderr_logger_st("mcdbn-cl"));
  spdlog::set_formatter(std::make_unique<PrintableLines>());
  spdlog::cfg::load_env_levels();
  // Our own messages report a damaged film, in place of those of OpenCV and FFmpeg.
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  ::setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0);
}

int report(const std::exception& error, ExitCode code) {
  spdlog::error("{}", with_flags(error.what()));
  return code;
}

/// The word that stands where a command should; empty if there is none or a command was given.
std::string unknown_command(const CLI::App& app) {
  const std::vector<std::string> unknown = app.remaining();
  return app.get_subcommands().empty() && !unknown.empty() ? unknown.front() : "";
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

/// What was wrong with the command line, and where its help is.
std::string usage_message(const CLI::App& app, const CLI::ParseError& error) {
  if (const std::string unknown = unknown_command(app); !unknown.empty())
    return fmt::format("unknown command {}; there are {} (see mcdbn-cl --help)", unknown,
                       fmt::join(command_names(app), ", "));
  const auto chosen = app.get_subcommands();
  return fmt::format("{} (see mcdbn-cl {}--help)", error.what(),
                     chosen.empty() ? "" : chosen.front()->get_name() + " ");
}

/// What the command line names beside its outputs: files, folders, and what is none.
std::vector<std::filesystem::path> inputs_of(const CLI::App& command,
                                             const CommandContext& context) {
  using Output = decltype(context.outputs)::value_type;
  std::vector<std::filesystem::path> inputs;
  for (const CLI::Option* option : command.get_options()) {
    if (std::ranges::count(context.outputs, option, &Output::first) > 0) continue;
    for (const std::string& argument : option->results()) {
      inputs.emplace_back(argument);
      if (const auto name_end = argument.find('='); name_end != std::string::npos)
        inputs.emplace_back(argument.substr(name_end + 1));  // --modality NAME=FILE
      if (const auto file_end = argument.rfind(':'); file_end != std::string::npos)
        inputs.emplace_back(argument.substr(0, file_end));  // --camera FILE:NAME
    }
  }
  return inputs;
}

/// The command's outputs come all or none, and replace nothing that it reads.
void run_command(const CLI::App& command, const CommandContext& context) {
  OutputBatch outputs(inputs_of(command, context));
  for (const auto& [option, kind] : context.outputs)
    if (!option->empty()) check_output(option->as<std::string>(), kind);
  context.run();
  outputs.put_in_place();
}

int parse_and_run(CLI::App& app, CommandContext& context, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // --help and --version, but not of what does not exist.
    if (error.get_exit_code() == kOk && unknown_command(app).empty()) return app.exit(error);
    spdlog::error("{}", usage_message(app, error));
    return kUsage;
  }
  if (context.quiet) spdlog::set_level(spdlog::level::warn);
  run_command(*app.get_subcommands().front(), context);
  if (!std::cout.flush() || std::fflush(stdout) != 0)
    throw Error("standard output: cannot be written; is the disk full?");
  return kOk;
}

}  // namespace

int run_program(int argc, char** argv, std::span<const AddCommand> commands) {
  try {
    occupy_standard_streams();
    start_signal_thread(kInterrupted);
    set_up_messages();
    CLI::App app{kDescription, "mcdbn-cl"};
    app.set_version_flag("--version", "mcdbn-cl " MCDBN_VERSION);
    app.require_subcommand(1);
    app.footer(kExitCodes);
    CommandContext context;
    context.arguments = argv;
    for (const auto add_command : commands) add_command(app, context);
    return parse_and_run(app, context, argc, argv);
  } catch (const Interrupted& error) {
    // At once: a driver may still be at work for us on a thread of its own.
    std::_Exit(report(error, kInterrupted));
  } catch (const InputError& error) {
    return report(error, kBadInput);
  } catch (const ConfigError& error) {
    return report(error, kUsage);
  } catch (const DeviceError& error) {
    return report(error, kNoDevice);
  } catch (const std::filesystem::filesystem_error& error) {
    // A name that is too long, links in a circle, a folder that may not be read.
    return report(InputError(fmt::format("{}: {}", error.path1().string(), error.code().message())),
                  kBadInput);
  } catch (const std::bad_alloc&) {
    return report(Error("out of memory; give fewer or shorter clips, or smaller settings"),
                  kFailure);
  } catch (const std::exception& error) {
    return report(error, kFailure);
  }
}

}  // namespace mcdbn::cli
