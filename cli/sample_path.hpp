#pragma once

#include <cstddef>
#include <filesystem>

namespace mcdbn::cli {

/// out.bvh, or out_01.bvh … for several samples.
std::filesystem::path sample_path(const std::filesystem::path& output, std::size_t sample,
                                  std::size_t samples);

}  // namespace mcdbn::cli
