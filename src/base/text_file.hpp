#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace mcdbn {

/// The whole file, byte for byte. @throws InputError if it cannot be read or is a folder
std::string read_text_file(const std::filesystem::path& path);

/// Writes a temporary file beside `path`, then renames it: readers see the old file or the whole
/// new one, and no partial file is left behind. @throws InputError if it cannot be written
void write_text_file(const std::filesystem::path& path, std::string_view text);

/// The folder, and those that it lies in, unless they exist. @throws InputError
void make_folder(const std::filesystem::path& folder);

}  // namespace mcdbn
