#pragma once

#include <filesystem>

namespace mcdbn::cli {

/// What lies beside the folder of this program, as share does beside bin. It need not be there.
/// @return empty if the program's own folder cannot be found
std::filesystem::path beside_program(const std::filesystem::path& file);

}  // namespace mcdbn::cli
