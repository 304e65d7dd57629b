#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/output_file.hpp"

namespace mcdbn::cli {

/// Context of every command. A command adds the options it obeys with the functions below, and
/// sets `run`, mostly by run_with; main calls `run` once the whole command line has been
/// understood.
struct CommandContext {
  std::string platform;  ///< name part or index, empty: any (also MCDBN_PLATFORM)
  std::string device;    ///< name part or index, empty: a GPU if there is one (also MCDBN_DEVICE)
  std::uint64_t seed = 1;
  bool quiet = false;
  bool json = false;
  std::vector<std::pair<CLI::Option*, OutputKind>> outputs;  ///< files to write: mark_output
  std::function<void()> run;
  char** arguments = nullptr;  ///< main's
};

void add_device_options(CLI::App& command, CommandContext& context);  ///< --platform, --device
void add_seed_option(CLI::App& command, CommandContext& context);     ///< --seed
void add_quiet_option(CLI::App& command, CommandContext& context);    ///< --quiet
void add_json_option(CLI::App& command, CommandContext& context);     ///< --json

/// The option names a file to write: it is looked at before the command runs, as check_output does,
/// and must be none that another option reads.
CLI::Option* mark_output(CLI::Option* option, CommandContext& context,
                         OutputKind kind = OutputKind::file);

/// Once the whole command line has been understood, the command is `run(context, *options)`.
template <typename Options, typename Run>
void run_with(CLI::App& command, CommandContext& context, std::shared_ptr<Options> options,
              Run run) {
  command.callback([&context, options, run] {
    context.run = [&context, options, run] { run(context, *options); };
  });
}

/// JSON as text; bytes of names in files that are no text become U+FFFD.
/// @param indent of lines; -1: one line
std::string json_text(const nlohmann::json& value, int indent = -1);

/// Writes one JSON object and a newline to stdout.
void print_json(const nlohmann::json& value);

// One for each file cli/NAME.cpp. To add a command: declare it here, list it in main.cpp.
// Messages for people go through spdlog (info, warn), which writes to stderr.
void add_devices_command(CLI::App& app, CommandContext& context);
void add_corpus_command(CLI::App& app, CommandContext& context);
void add_info_command(CLI::App& app, CommandContext& context);
void add_project_command(CLI::App& app, CommandContext& context);
void add_render_command(CLI::App& app, CommandContext& context);
void add_synthesize_command(CLI::App& app, CommandContext& context);
void add_fit_command(CLI::App& app, CommandContext& context);
void add_sample_command(CLI::App& app, CommandContext& context);
void add_score_command(CLI::App& app, CommandContext& context);
void add_transform_command(CLI::App& app, CommandContext& context);
void add_train_command(CLI::App& app, CommandContext& context);
void add_regenerate_command(CLI::App& app, CommandContext& context);
void add_generate_command(CLI::App& app, CommandContext& context);
void add_evaluate_command(CLI::App& app, CommandContext& context);
void add_bench_command(CLI::App& app, CommandContext& context);

}  // namespace mcdbn::cli
