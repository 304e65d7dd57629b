#include "output_ending.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <system_error>

#include "base/lower_extension.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/camera_file.hpp"

namespace mcdbn::cli {

namespace fs = std::filesystem;

std::string ending_of(const fs::path& output) {
  std::error_code error;
  if (fs::is_other(output, error)) return "";
  return lower_extension(output);
}

void check_ending(const fs::path& output, const std::vector<std::string>& endings) {
  const std::string ending = ending_of(output);
  if (ending.empty() || std::ranges::find(endings, ending) != endings.end()) return;
  throw ConfigError(fmt::format("--output {}: cannot write {} here; use {}", output.string(),
                                ending, fmt::join(endings, ", ")));
}

void check_camera_output(const fs::path& output) {
  if (!output.empty() && !has_camera_ending(output))
    throw ConfigError(
        fmt::format("--write-camera {}: give a .yml, .yaml, .xml or .json", output.string()));
}

}  // namespace mcdbn::cli
