#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace mcdbn::test {

/// One option of a command (or a positional argument, by its name), and the check that it does what
/// its help describes: what must change in the output when it is given.
struct OptionRow {
  std::string option;
  std::function<void()> check;
};

/// The commands that `--help` lists, and the line beside each that tells what it does.
std::map<std::string, std::string> commands_in_help();

/// What `COMMAND --help` lists: long options with their dashes, positional arguments by name;
/// without --help itself.
std::set<std::string> options_in_help(const std::string& command);

/// Runs the check of every row. Fails if an option that the help lists has no row, or a row no
/// option.
void check_options(const std::string& command, const std::vector<OptionRow>& rows);

/// Rows of --platform and --device: a name that no device has is exit code 4 with the list of those
/// there are and no output, one that fits gives what no name gives.
/// @param arguments of a call that works, the command first
/// @param output what that call gave, read anew after every call
std::vector<OptionRow> device_rows(const std::string& arguments,
                                   const std::function<std::string()>& output);

}  // namespace mcdbn::test
