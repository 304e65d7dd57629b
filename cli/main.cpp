#include <fmt/ranges.h>
#include <spdlog/cfg/env.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <array>
#include <cstdio>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "commands.hpp"
#include "mcdbn/base/errors.hpp"
#include "setting_flags.hpp"

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

constexpr std::array kCommands = {
    add_devices_command,   add_synthesize_command, add_project_command,    add_render_command,
    add_corpus_command,    add_train_command,      add_regenerate_command, add_generate_command,
    add_evaluate_command,  add_fit_command,        add_sample_command,     add_score_command,
    add_transform_command, add_info_command,       add_bench_command,
};

constexpr const char* kDescription =
    "Trains multimodal conditional deep belief networks on motion capture and regenerates 3D "
    "motion\n"
    "from the 2D joint tracks of one camera, on any OpenCL device.";

constexpr const char* kExitCodes =
    "Exit codes: 0 ok, 1 failure, 2 usage or configuration, 3 bad input, 4 no device, 130 "
    "interrupted.";

/// People read stderr, programs read stdout: all messages go to stderr as plain lines.
/// SPDLOG_LEVEL=debug shows more.
void set_up_messages() {
  spdlog::set_default_logger(spdlog::stderr_logger_st("mcdbn-cl"));
  spdlog::set_pattern("mcdbn-cl: %l: %v");
  spdlog::cfg::load_env_levels();
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
  context.run();
  if (!std::cout.flush() || std::fflush(stdout) != 0)
    throw Error("standard output: cannot be written; is the disk full?");
  return kOk;
}

int run_program(int argc, char** argv) {
  try {
    set_up_messages();
    CLI::App app{kDescription, "mcdbn-cl"};
    app.set_version_flag("--version", "mcdbn-cl " MCDBN_VERSION);
    app.require_subcommand(1);
    app.footer(kExitCodes);
    CommandContext context;
    for (const auto add_command : kCommands) add_command(app, context);
    return parse_and_run(app, context, argc, argv);
  } catch (const Interrupted& error) {
    return report(error, kInterrupted);
  } catch (const InputError& error) {
    return report(error, kBadInput);
  } catch (const ConfigError& error) {
    return report(error, kUsage);
  } catch (const DeviceError& error) {
    return report(error, kNoDevice);
  } catch (const std::exception& error) {
    return report(error, kFailure);
  }
}

}  // namespace
}  // namespace mcdbn::cli

int main(int argc, char** argv) {
  return mcdbn::cli::run_program(argc, argv);
}
