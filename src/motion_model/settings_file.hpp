#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace mcdbn {

/// @throws ConfigError `file:line: what` if it is missing or no TOML
toml::table read_toml_file(const std::filesystem::path& file);

/// `file:line`, where the node stands.
std::string location_of(const std::filesystem::path& file, const toml::node& node);

/// A number, true or false; null for what no setting can be.
nlohmann::json scalar_of(const toml::node& node);

}  // namespace mcdbn
