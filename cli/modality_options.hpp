#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "matrix_options.hpp"

namespace mcdbn::cli {

/// Data of one name of --modality NAME=FILE.
struct ModalityData {
  std::string name;
  MatrixInput files;
  std::vector<MatrixF> data;
};

void add_modality_option(CLI::App& command, std::vector<std::string>& arguments, const char* help);

/// Reads the files, those of one name together, in the order of the names.
/// @param arguments NAME=FILE each
/// @throws ConfigError for what is no NAME=FILE; InputError unless the files of all names have the
/// same numbers of rows
std::vector<ModalityData> read_modalities(const std::vector<std::string>& arguments,
                                          const std::string& tensor);

/// An MRBM's modalities as it sees them.
struct MrbmUnits {
  std::vector<Matrix> units;  ///< [rows x visible] of each, zeros where nothing is given
  std::vector<bool> given;    ///< of each modality
  std::size_t rows() const { return units.front().rows(); }
};

/// @param option that takes MRBMs only, for the error  @throws InputError for other machines
const Mrbm& mrbm_of(const SavedMachine& saved, const std::filesystem::path& file,
                    const char* option);

/// @param option that gave the name  @throws ConfigError for a name that the MRBM has not
std::size_t modality_of(const Mrbm& mrbm, const std::string& name, const char* option);

/// The data that were read, in the machine's order and by its scales, all rows `copies` times over;
/// `copies` rows if nothing was read.
/// @throws ConfigError, InputError for data that are not the machine's
MrbmUnits mrbm_units(Device& device, const SavedMachine& saved, const Mrbm& mrbm,
                     const std::vector<ModalityData>& inputs, std::size_t copies = 1);

}  // namespace mcdbn::cli
