#include "base/lower_extension.hpp"

#include <algorithm>
#include <cctype>

namespace mcdbn {

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char letter) { return std::tolower(letter); });
  return extension;
}

}  // namespace mcdbn
