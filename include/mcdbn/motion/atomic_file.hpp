#pragma once

#include <filesystem>
#include <string_view>

namespace mcdbn {

/// Writes the whole file beside its final place and renames it there, so that no reader ever sees,
/// and no failure ever leaves, a partial file.
/// @throws InputError if the folder is missing or not writable, or the disk is full
void write_file_atomically(const std::filesystem::path& path, std::string_view content);

}  // namespace mcdbn
