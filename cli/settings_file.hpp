#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace mcdbn::cli {

/// @param option that names the file, for the message
/// @throws ConfigError, as `file:line: what`
toml::table read_settings_file(const std::filesystem::path& file, const std::string& option);

/// `file:line`
std::string location_of(const std::filesystem::path& file, const toml::source_region& source);

/// A number, true or false; null for what no setting can be.
nlohmann::json scalar_of(const toml::node& node);

}  // namespace mcdbn::cli
