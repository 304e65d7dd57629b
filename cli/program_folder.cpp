#include "program_folder.hpp"

namespace mcdbn::cli {

std::filesystem::path beside_program(const std::filesystem::path& folder) {
  std::error_code unknown;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", unknown);
  return program.parent_path().parent_path() / folder;
}

}  // namespace mcdbn::cli
