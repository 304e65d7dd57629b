#pragma once

#include <span>

#include "commands.hpp"

namespace mcdbn::cli {

using AddCommand = void (*)(CLI::App&, CommandContext&);

/// Understands the command line and runs the command that it names. What it throws becomes a
/// message and an exit code here. @return the exit code
int run_program(int argc, char** argv, std::span<const AddCommand> commands);

}  // namespace mcdbn::cli
