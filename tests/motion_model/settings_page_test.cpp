// The table of settings in docs/formats.md has every setting, with the defaults that it has.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "base/text_file.hpp"
#include "mcdbn/motion_model/training_config.hpp"

namespace settings_page_test {

using namespace mcdbn;
using nlohmann::json;

namespace {

constexpr std::size_t kColumns = 3;  // default, greedy, paper

/// The settings of each column by name, and the names in their order.
struct Settings {
  std::array<std::map<std::string, json>, kColumns> values;
  std::vector<std::string> names;
};

Settings settings() {
  Settings result;
  const std::array configs{TrainingConfig(), TrainingConfig::greedy(), TrainingConfig::paper()};
  for (std::size_t column = 0; column < kColumns; ++column)
    visit_settings(configs[column], [&](const Setting& setting, const auto& value) {
      result.values[column][setting.name] = value;
      if (column == 0) result.names.push_back(setting.name);
    });
  return result;
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(' ');
  return first == std::string::npos ? ""
                                    : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, at);) parts.push_back(trimmed(part));
  return parts;
}

/// The table's rows, each as its cells.
std::vector<std::vector<std::string>> rows_of_page() {
  const std::string page = read_text_file(MCDBN_SOURCE_DIR "/docs/formats.md");
  const auto begin = page.find("\n## Settings (TOML)\n");
  REQUIRE(begin != std::string::npos);
  std::istringstream lines(page.substr(begin, page.find("\n## ", begin + 1) - begin));
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("| `")) rows.push_back(split(line.substr(1), '|'));
  return rows;
}

/// `a`, `b`: those; `a` … `c`: these and all between.
std::vector<std::string> names_in(const std::string& cell, const std::vector<std::string>& order) {
  std::vector<std::string> names;
  const std::vector<std::string> parts = split(cell, '`');
  for (std::size_t i = 1; i < parts.size(); i += 2) names.push_back(parts[i]);
  if (cell.find("…") == std::string::npos) return names;
  REQUIRE(names.size() == 2);
  const auto first = std::find(order.begin(), order.end(), names[0]),
             last = std::find(order.begin(), order.end(), names[1]);
  REQUIRE(first < last);
  REQUIRE(last != order.end());
  return {first, last + 1};
}

/// A cell of values, "0.1, 0" of two names or one for all. What follows a semicolon is for people.
json value_in(const std::string& cell, std::size_t name) {
  const std::vector<std::string> values = split(cell.substr(0, cell.find(';')), ',');
  const std::string& value = values.size() == 1 ? values[0] : values.at(name);
  return value == "true" || value == "false" ? json(value == "true") : json(std::stod(value));
}

}  // namespace

TEST_CASE("the page of settings has each of them once, with its defaults") {
  const Settings all = settings();
  std::map<std::string, int> listed;
  for (const std::vector<std::string>& cells : rows_of_page()) {
    CAPTURE(cells[0]);
    REQUIRE(cells.size() >= 1 + kColumns);
    const std::vector<std::string> names = names_in(cells[0], all.names);
    for (std::size_t i = 0; i < names.size(); ++i) {
      CAPTURE(names[i]);
      ++listed[names[i]];
      REQUIRE(all.values[0].contains(names[i]));
      for (std::size_t column = 0; column < kColumns; ++column) {
        CAPTURE(column);
        const auto& values = all.values[column];
        const std::string& cell = cells[1 + column];
        // "as `gaussian.…`": the same of the other units.
        const bool as_gaussian = cells[1].starts_with("as ");
        const json wanted = as_gaussian
                                ? values.at("gaussian" + names[i].substr(names[i].find('.')))
                            : cell.empty() ? all.values[0].at(names[i])
                                           : value_in(cell, i);
        CHECK(values.at(names[i]) == wanted);
      }
    }
  }
  for (const std::string& name : all.names) CHECK_MESSAGE(listed[name] == 1, name);
}

}  // namespace settings_page_test
