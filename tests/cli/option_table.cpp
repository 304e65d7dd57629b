#include "option_table.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "run_cli.hpp"

namespace mcdbn::test {
namespace {

/// "-o,--output" or "--mirror,--no-mirror{false}": the long names.
std::vector<std::string> long_names(const std::string& word) {
  std::vector<std::string> names;
  std::istringstream parts(word);
  for (std::string name; std::getline(parts, name, ',');)
    if (name.starts_with("--")) names.push_back(name.substr(0, name.find('{')));
  return names;
}

/// Where the texts of the help begin.
constexpr std::size_t kHelpColumn = 30;
const std::string kNoOption(kHelpColumn, ' ');

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

const nlohmann::json& first_device() {
  static const nlohmann::json listed =
      nlohmann::json::parse(run_cli("devices --json").standard_output);
  return listed.at("devices").at(0);
}

void check_no_such_device(const std::string& call) {
  const CliResult result = run_cli(call);
  CAPTURE(result.standard_error);
  CHECK(result.exit_code == 4);
  CHECK(result.standard_output.empty());
  CHECK(result.standard_error.find("no-such-name") != std::string::npos);
  const nlohmann::json& device = first_device();
  for (const char* field : {"name", "platform"})
    CHECK(result.standard_error.find(device.at(field).get<std::string>()) != std::string::npos);
}

}  // namespace

std::map<std::string, std::string> commands_in_help() {
  const std::string help = run_cli("--help").standard_output;
  const auto start = help.find("Subcommands:\n");
  REQUIRE(start != std::string::npos);
  std::istringstream lines(help.substr(start));
  std::string line;
  std::getline(lines, line);
  std::map<std::string, std::string> commands;
  while (std::getline(lines, line) && line.starts_with("  ")) {
    if (line[2] == ' ') continue;  // a description that ran on
    const auto end = std::min(line.find(' ', 2), line.size());
    commands.emplace(line.substr(2, end - 2), line.substr(end));
  }
  return commands;
}

std::set<std::string> options_in_help(const std::string& command) {
  const CliResult help = run_cli(command + " --help");
  REQUIRE(help.exit_code == 0);
  std::set<std::string> options;
  bool positionals = false;
  const std::vector<std::string> lines = lines_of(help.standard_output);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string& line = lines[i];
    if (line.starts_with("Example")) break;
    if (!line.empty() && line[0] != ' ') positionals = line == "Positionals:";
    if (!line.starts_with("  ") || line.starts_with("   ")) continue;  // or a text that goes on
    const std::string word = line.substr(2, line.find(' ', 2) - 2);
    // Beside it or, where it is long, below.
    const bool explained = (line.size() > kHelpColumn && line[kHelpColumn - 1] == ' ') ||
                           (i + 1 < lines.size() && lines[i + 1].starts_with(kNoOption));
    CHECK_MESSAGE(explained, command, " ", word, " has a text that explains it");
    if (positionals)
      options.insert(word);
    else
      for (const std::string& name : long_names(word)) options.insert(name);
  }
  REQUIRE(options.erase("--help") == 1);
  return options;
}

void check_options(const std::string& command, const std::vector<OptionRow>& rows) {
  std::set<std::string> listed = options_in_help(command);
  for (const OptionRow& row : rows) {
    INFO(command, " ", row.option);
    CHECK_MESSAGE(listed.erase(row.option) == 1, "the help lists it, and no other row has it");
    row.check();
  }
  for (const std::string& option : listed) {
    INFO(command, " ", option);
    FAIL_CHECK("an option without a row that checks what it changes");
  }
}

std::vector<OptionRow> device_rows(const std::string& arguments,
                                   const std::function<std::string()>& output) {
  REQUIRE(run_cli(arguments).exit_code == 0);
  const std::string plain = output();
  const auto check = [=](const std::string& option, const std::string& field) {
    const std::string name = first_device().at(field).get<std::string>();
    REQUIRE(name.size() > 4);
    const std::string part = name.substr(1, name.size() - 2);
    CHECK(run_cli(arguments + " " + option + " '" + part + "'").exit_code == 0);
    CHECK(output() == plain);
    check_no_such_device(arguments + " " + option + " no-such-name");
  };
  return {{"--platform", [=] { check("--platform", "platform"); }},
          {"--device", [=] { check("--device", "name"); }}};
}

}  // namespace mcdbn::test
