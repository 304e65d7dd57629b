#include <iostream>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "setting_flags.hpp"

namespace mcdbn::cli {

void add_device_options(CLI::App& command, CommandContext& context) {
  command
      .add_option("--platform", context.platform,
                  "OpenCL platform: index, or part of its name (see `mcdbn-cl devices`)")
      ->envname("MCDBN_PLATFORM")
      ->type_name("NAME|INDEX");
  command
      .add_option("--device", context.device,
                  "OpenCL device: index, or part of its name (default: a GPU, else the CPU)")
      ->envname("MCDBN_DEVICE")
      ->type_name("NAME|INDEX");
}

void add_seed_option(CLI::App& command, CommandContext& context) {
  add_setting_flag(command, "--seed", {"seed", any_seed(), "", "seed of all random numbers"},
                   context.seed);
}

void add_quiet_option(CLI::App& command, CommandContext& context) {
  command.add_flag("--quiet", context.quiet, "No progress and no messages but warnings and errors");
}

void add_json_option(CLI::App& command, CommandContext& context) {
  command.add_flag("--json", context.json, "Print one JSON object to stdout");
}

CLI::Option* mark_output(CLI::Option* option, CommandContext& context, OutputKind kind) {
  context.outputs.emplace_back(option, kind);
  return option;
}

std::string json_text(const nlohmann::json& value, int indent) {
  return value.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
}

void print_json(const nlohmann::json& value) {
  std::cout << json_text(value, 2) << '\n';
}

}  // namespace mcdbn::cli
