#pragma once

#include <filesystem>

namespace mcdbn::cli {

/// A folder beside that of this program, as share is beside bin; there it need not be.
std::filesystem::path beside_program(const std::filesystem::path& folder);

}  // namespace mcdbn::cli
