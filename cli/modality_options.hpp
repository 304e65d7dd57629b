#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "matrix_options.hpp"

namespace mcdbn::cli {

/// What --modality NAME=FILE said of one name.
struct ModalityData {
  std::string name;
  MatrixInput files;
  std::vector<MatrixF> data;
};

void add_modality_option(CLI::App& command, std::vector<std::string>& said, const char* help);

/// Reads the files, those of one name together, in the order in which the names come.
/// @throws ConfigError for what is no NAME=FILE; InputError unless the files of all names have the
/// same numbers of rows
std::vector<ModalityData> read_modalities(const std::vector<std::string>& said,
                                          const std::string& tensor);

}  // namespace mcdbn::cli
