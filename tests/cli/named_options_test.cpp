// Words in backquotes in the library's messages, which the program shows as its flags.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "base/text_file.hpp"
#include "option_table.hpp"
#include "run_cli.hpp"

namespace named_options_test {

using namespace mcdbn::test;
namespace fs = std::filesystem;

namespace {

std::set<std::string> options_of_all_commands() {
  std::set<std::string> options;
  for (const auto& [command, description] : commands_in_help())
    options.merge(options_in_help(command));
  return options;
}

/// The words in backquotes in the string literals of a source file.
std::set<std::string> quoted_words(const fs::path& source) {
  static const std::regex literal(R"("(?:[^"\\]|\\.)*")"), word("`([a-z][a-zA-Z.-]*)`");
  std::set<std::string> words;
  std::istringstream lines(mcdbn::read_text_file(source));
  for (std::string line; std::getline(lines, line);) {
    const auto first = line.find_first_not_of(' ');
    if (first == std::string::npos || line.compare(first, 2, "//") == 0) continue;
    for (std::sregex_iterator text(line.begin(), line.end(), literal), end; text != end; ++text) {
      const std::string content = text->str();
      for (std::sregex_iterator found(content.begin(), content.end(), word); found != end; ++found)
        words.insert((*found)[1]);
    }
  }
  return words;
}

}  // namespace

TEST_CASE("the library's messages name only options that a command has") {
  const std::set<std::string> options = options_of_all_commands();
  std::set<std::string> named;
  for (const char* folder : {"src", "include"})
    for (const auto& entry :
         fs::recursive_directory_iterator(fs::path(MCDBN_SOURCE_DIR) / folder)) {
      if (entry.path().extension() != ".cpp" && entry.path().extension() != ".hpp") continue;
      for (const std::string& word : quoted_words(entry.path())) {
        std::string flag = "--" + word;
        std::ranges::replace(flag, '.', '-');
        CHECK_MESSAGE(options.contains(flag), entry.path().string(), ": ", flag);
        named.insert(word);
      }
    }
  for (const char* known : {"image-size", "fine-tuning.rate", "include-training"})
    CHECK(named.contains(known));
}

}  // namespace named_options_test
