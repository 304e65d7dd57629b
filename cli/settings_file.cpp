#include "settings_file.hpp"

#include <fmt/format.h>

#include "mcdbn/base/errors.hpp"

namespace mcdbn::cli {

toml::table read_settings_file(const std::filesystem::path& file, const std::string& option) {
  if (!std::filesystem::is_regular_file(file))
    throw ConfigError(fmt::format("{}: no such file; {} wants a TOML file", file.string(), option));
  try {
    return toml::parse_file(file.string());
  } catch (const toml::parse_error& error) {
    throw ConfigError(
        fmt::format("{}: {}", location_of(file, error.source()), error.description()));
  }
}

std::string location_of(const std::filesystem::path& file, const toml::source_region& source) {
  return fmt::format("{}:{}", file.string(), source.begin.line);
}

nlohmann::json scalar_of(const toml::node& node) {
  if (const auto* boolean = node.as_boolean()) return boolean->get();
  if (const auto* integer = node.as_integer()) return integer->get();
  if (const auto* number = node.as_floating_point()) return number->get();
  return nullptr;
}

}  // namespace mcdbn::cli
