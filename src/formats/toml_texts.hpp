#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <string>
#include <string_view>

namespace mcdbn {

// TOML files of texts: joint maps, lists of clips.

/// @throws InputError `file:line: what`, always
[[noreturn]] void fail_at(const std::filesystem::path& path, const toml::source_region& source,
                          const std::string& what);

/// @param example what to give, for the error
/// @throws InputError if it cannot be read or is no TOML
toml::table read_toml(const std::filesystem::path& path, std::string_view example);

/// @param what the text is, for the error: "a text"
/// @throws InputError if the node is no text, or an empty one
std::string text_of(const std::filesystem::path& path, std::string_view key, const toml::node& node,
                    std::string_view what);

}  // namespace mcdbn
