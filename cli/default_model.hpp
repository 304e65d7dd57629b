#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>

namespace mcdbn::cli {

/// Adds --model for a trained model of motion; without it the one that comes with the program.
void add_model_option(CLI::App& command, std::filesystem::path& model);

/// `said`, or else the model that comes with the program, which is told: it lies under
/// share/mcdbn-cl beside the program's own folder. @throws ConfigError if there is none
std::filesystem::path model_or_default(const std::filesystem::path& said);

}  // namespace mcdbn::cli
