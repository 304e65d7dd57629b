#include "program_folder.hpp"

namespace mcdbn::cli {

std::filesystem::path beside_program(const std::filesystem::path& file) {
  std::error_code unknown;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", unknown);
  if (unknown) return {};
  return program.parent_path().parent_path() / file;
}

}  // namespace mcdbn::cli
