#pragma once

#include <filesystem>
#include <string>

namespace mcdbn {

/// The ending of a file's name in lower case, with its dot; empty where the name has none.
std::string lower_extension(const std::filesystem::path& path);

}  // namespace mcdbn
