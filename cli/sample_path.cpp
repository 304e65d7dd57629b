#include "sample_path.hpp"

#include <fmt/format.h>

namespace mcdbn::cli {

std::filesystem::path sample_path(const std::filesystem::path& output, std::size_t sample,
                                  std::size_t samples) {
  if (samples == 1) return output;
  const std::string name =
      fmt::format("{}_{:02}{}", output.stem().string(), sample + 1, output.extension().string());
  return output.parent_path() / name;
}

}  // namespace mcdbn::cli
