#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "commands.hpp"
#include "mcdbn/base/matrices.hpp"
#include "mcdbn/machines/machine_file.hpp"

namespace mcdbn::cli {

/// Data of files, one sequence each.
struct MatrixInput {
  std::vector<std::filesystem::path> files;
  std::string tensor;

  /// @throws InputError naming the file whose columns are not those of the first
  std::vector<MatrixF> read() const;
};
/// @param name of the option or positional argument
CLI::Option* add_matrix_input(CLI::App& command, MatrixInput& input, const std::string& name,
                              const std::string& help);

/// -o,--output: a file, or CSV on standard output.
void add_matrix_output(CLI::App& command, CommandContext& context, std::filesystem::path& output,
                       const char* help);
/// @throws ConfigError for a file of a kind that cannot be written, before any work
void check_matrix_output(const std::filesystem::path& output);
void put_matrix(const std::filesystem::path& output, const MatrixF& values);

/// --model of a command that uses a machine that `fit` wrote.
void add_machine_option(CLI::App& command, std::filesystem::path& model);

/// The layers of a machine that is an RBM, a CRBM or a stack of them.
/// @throws InputError for others, naming the file
Cdbn stack_of(const SavedMachine& saved, const std::filesystem::path& file);

/// Data as the machine sees them, and what it gives as the data were: by the modality's scale, if
/// it has one.
/// @param files for errors  @throws InputError if the columns are not the machine's
std::vector<MatrixF> scaled(const SavedMachine& saved, std::vector<MatrixF> data,
                            std::size_t visible, const MatrixInput& files,
                            std::size_t modality = 0);
MatrixF unscaled(const SavedMachine& saved, const MatrixF& values, std::size_t modality = 0);

/// Checks that at least one sequence is longer than the history, and warns of each that is not.
/// @param files of the data, for messages  @throws InputError if none is
void check_lengths(const std::vector<MatrixF>& data, std::size_t order,
                   const std::vector<std::filesystem::path>& files);
/// The files' data as a stack can take them, checked and scaled. @throws InputError
std::vector<MatrixF> checked_and_scaled(const SavedMachine& saved, const Cdbn& stack,
                                        const MatrixInput& files);

/// The rows from `first` on of each sequence, one after another.
MatrixF stacked(const std::vector<MatrixF>& sequences, std::size_t first);

}  // namespace mcdbn::cli
