#include "motion_model/settings_file.hpp"

#include <fmt/format.h>

#include <sstream>

#include "base/shown.hpp"
#include "base/text_file.hpp"
#include "base/toml_keys.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/motion_model/settings_record.hpp"
#include "motion_model/text_settings.hpp"

namespace mcdbn {
namespace {

std::string location(const std::filesystem::path& file, const toml::source_region& source) {
  return fmt::format("{}:{}", file.string(), source.begin.line);
}

/// A key as errors have it: any text may stand there.
std::string named(const std::string& key) {
  constexpr std::size_t kLongest = 60;
  return printable(key.substr(0, kLongest));
}

/// A setting's value, or a text.
nlohmann::json value_of(const toml::node& node) {
  if (const auto* text = node.as_string()) return text->get();
  return scalar_of(node);
}

void add_table(std::vector<GivenSetting>& given, const std::filesystem::path& file,
               const toml::table& table, const std::string& prefix) {
  for (const auto& [key, node] : table) {
    const std::string name = prefix + std::string(key.str());
    if (const toml::table* inner = node.as_table())
      add_table(given, file, *inner, name + ".");
    else
      given.push_back(
          {name, value_of(node), fmt::format("{}: {}", location_of(file, node), named(name))});
  }
}

}  // namespace

toml::table read_toml_file(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file))
    throw ConfigError(fmt::format("{}: no such file; a TOML file is wanted", file.string()));
  const std::string text = read_text_file(file);
  if (const auto line = line_of_long_key(text))
    throw ConfigError(
        fmt::format("{}:{}: a key of more parts than any setting", file.string(), *line));
  try {
    return toml::parse(text, file.string());
  } catch (const toml::parse_error& error) {
    throw ConfigError(
        fmt::format("{}: no readable TOML from here on", location(file, error.source())));
  }
}

std::string location_of(const std::filesystem::path& file, const toml::node& node) {
  return location(file, node.source());
}

nlohmann::json scalar_of(const toml::node& node) {
  if (const auto* boolean = node.as_boolean()) return boolean->get();
  if (const auto* integer = node.as_integer()) return integer->get();
  if (const auto* number = node.as_floating_point()) return number->get();
  return nullptr;
}

std::vector<GivenSetting> read_settings_file(const std::filesystem::path& file) {
  std::vector<GivenSetting> given;
  add_table(given, file, read_toml_file(file), "");
  return given;
}

std::string settings_toml(const TrainingConfig& config) {
  toml::table table;
  const auto put = [&](const std::string& name, const auto& value) {
    const auto dot = name.find('.');
    if (dot == std::string::npos)
      table.insert(name, value);
    else
      table.insert(name.substr(0, dot), toml::table{})
          .first->second.as_table()
          ->insert(name.substr(dot + 1), value);
  };
  visit_settings(config, [&](const Setting& setting, const auto& value) {
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::size_t>)
      put(setting.name, static_cast<std::int64_t>(value));
    else
      put(setting.name, value);
  });
  for (const auto& [name, text] : text_settings(config)) put(name, text);
  std::ostringstream text;
  text << table << '\n';
  return text.str();
}

}  // namespace mcdbn
