#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/output_file.hpp"

namespace mcdbn {

/// The whole file, byte for byte. @throws InputError if it cannot be read or is a folder
std::string read_text_file(const std::filesystem::path& path);

/// Writes the file as an OutputFile: readers see the old file or the whole new one, and no partial
/// file is left behind. @throws InputError if it cannot be written
void write_text_file(const std::filesystem::path& path, std::string_view text);

}  // namespace mcdbn
