#include "output_ending.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <system_error>

#include "mcdbn/base/errors.hpp"

namespace mcdbn::cli {

namespace fs = std::filesystem;

std::string ending_of(const fs::path& output) {
  std::error_code error;
  if (fs::is_other(output, error)) return "";
  std::string ending = output.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char letter) { return std::tolower(letter); });
  return ending;
}

void check_ending(const fs::path& output, const std::vector<std::string>& endings) {
  const std::string ending = ending_of(output);
  if (ending.empty() || std::ranges::find(endings, ending) != endings.end()) return;
  throw ConfigError(
      fmt::format("--output {}: what is written there is no {}; give a name that ends in {}",
                  output.string(), ending, fmt::join(endings, ", ")));
}

}  // namespace mcdbn::cli
