#include <fmt/format.h>

#include "base/shown.hpp"
#include "comparison/sweep.hpp"
#include "mcdbn/base/errors.hpp"
#include "motion_model/settings_file.hpp"

namespace mcdbn {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void reject(const fs::path& file, const toml::node& node, const std::string& what) {
  throw ConfigError(fmt::format("{}: {}", location_of(file, node), what));
}

nlohmann::json setting_of(const fs::path& file, const toml::node& node) {
  nlohmann::json value = scalar_of(node);
  if (value.is_null()) reject(file, node, "a setting is a number or true or false");
  return value;
}

/// The choices for each setting of a table, `a.b` for nested ones; one choice where there is no
/// list.
std::vector<std::vector<GivenSetting>> choices_of(const fs::path& file, const toml::table& table,
                                                  const std::string& prefix = "") {
  std::vector<std::vector<GivenSetting>> all;
  for (const auto& [key, node] : table) {
    const std::string name = prefix + std::string(key.str());
    if (const toml::table* inner = node.as_table()) {
      for (auto& choices : choices_of(file, *inner, name + ".")) all.push_back(std::move(choices));
      continue;
    }
    const std::string who =
        fmt::format("{}: {}", location_of(file, node), printable(name.substr(0, 60)));
    std::vector<GivenSetting> choices;
    if (const toml::array* list = node.as_array()) {
      for (const toml::node& value : *list) choices.push_back({name, setting_of(file, value), who});
      if (choices.empty()) reject(file, node, fmt::format("{} has no value to try", shown(name)));
    } else {
      choices.push_back({name, setting_of(file, node), who});
    }
    all.push_back(std::move(choices));
  }
  return all;
}

/// @throws ConfigError if they are too many to be meant
void check_number_of_runs(const fs::path& file, double runs) {
  constexpr double kMost = 10'000;
  if (runs > kMost)
    throw ConfigError(fmt::format("{}: {:.0f} configurations; a sweep has {:.0f} at most",
                                  file.string(), runs, kMost));
}

std::vector<SweepConfiguration> combinations(
    const fs::path& file, const std::vector<std::vector<GivenSetting>>& choices) {
  double runs = 1;
  for (const auto& values : choices) runs *= static_cast<double>(values.size());
  check_number_of_runs(file, runs);
  std::vector<SweepConfiguration> all = {{}};
  for (const auto& values : choices) {
    std::vector<SweepConfiguration> longer;
    for (const SweepConfiguration& start : all)
      for (const GivenSetting& value : values) {
        longer.push_back(start);
        longer.back().push_back(value);
      }
    all = std::move(longer);
  }
  return all;
}

std::vector<fs::path> test_paths(const fs::path& file, const toml::node& node) {
  std::vector<fs::path> paths;
  const toml::array* list = node.as_array();
  if (!list || list->empty()) reject(file, node, "'test' is a list of BVH files or folders");
  for (const toml::node& entry : *list) {
    const auto path = entry.value<std::string>();
    if (!path) reject(file, entry, "'test' is a list of BVH files or folders");
    paths.push_back(file.parent_path() / *path);
  }
  return paths;
}

SweepFile sweep_of(const fs::path& file, const toml::table& table) {
  SweepFile sweep;
  for (const auto& [key, node] : table) {
    std::vector<SweepConfiguration> more;
    if (key.str() == "test") {
      sweep.test = test_paths(file, node);
    } else if (key.str() == "grid" && node.is_table()) {
      more = combinations(file, choices_of(file, *node.as_table()));
    } else if (key.str() == "configuration" && node.is_array_of_tables()) {
      for (const toml::node& entry : *node.as_array())
        for (SweepConfiguration& one : combinations(file, choices_of(file, *entry.as_table())))
          more.push_back(std::move(one));
    } else {
      reject(file, node,
             fmt::format("{} is none of: test, [grid], [[configuration]]", shown(key.str())));
    }
    sweep.configurations.insert(sweep.configurations.end(), more.begin(), more.end());
    check_number_of_runs(file, static_cast<double>(sweep.configurations.size()));
  }
  if (sweep.test.empty())
    throw ConfigError(fmt::format("{}: no 'test': name the clips to score on", file.string()));
  if (sweep.configurations.empty())
    throw ConfigError(
        fmt::format("{}: nothing to try: give a [grid] or [[configuration]]", file.string()));
  return sweep;
}

}  // namespace

SweepFile read_sweep_file(const fs::path& path) {
  return sweep_of(path, read_toml_file(path));
}

}  // namespace mcdbn
