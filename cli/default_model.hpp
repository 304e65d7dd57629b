#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

namespace mcdbn::cli {

/// Adds --model for a trained model of motion; without it the one that comes with the program.
/// @return the option, whose description is one for every use
CLI::Option* add_model_option(CLI::App& command, std::filesystem::path& model);

/// `given`; where it is empty, the model that comes with the program, with a notice. That lies
/// under share/mcdbn-cl beside the program's own folder.
/// @param instead what the command line has in place of a file, for the notice
/// @throws ConfigError if there is none
std::filesystem::path model_or_default(const std::filesystem::path& given,
                                       const std::string& instead = "no --model");

}  // namespace mcdbn::cli
