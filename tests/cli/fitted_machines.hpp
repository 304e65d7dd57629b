#pragma once

#include <filesystem>
#include <string>

#include "base/scratch_folder.hpp"
#include "mcdbn/machines/machine_file.hpp"
#include "option_table.hpp"

namespace mcdbn::test {

/// Settings with which the fit of an RBM or CRBM of that kind, or a stack of them, takes no time.
std::string short_fit(const std::string& kind);

/// Data of both kinds in files, 60 rows of 5 values, and machines that were fitted to them, made
/// once for all tests of a file.
class FittedMachines {
 public:
  static const FittedMachines& instance();
  /// The file of a machine of that kind, each fitted when it is first asked for.
  std::string model(const std::string& kind) const;
  std::string bits() const { return (folder_ / "bits.npy").string(); }
  std::string values() const { return (folder_ / "values.csv").string(); }
  std::string data_of(const std::string& kind) const;

 private:
  FittedMachines();
  ScratchFolder folder_;
};

/// Runs a command that works. @return its standard output
std::string output_of(const std::string& call);
/// A matrix that a command printed as CSV.
MatrixF printed(const std::string& call);
void check_refused(const std::string& call, int exit_code, const std::string& words);
/// The machine of a file, on the device that the program takes.
SavedMachine loaded(const std::string& file);

/// Rows of --platform and --device that start the program once.
std::vector<OptionRow> refused_device_rows(const std::string& call);

}  // namespace mcdbn::test
