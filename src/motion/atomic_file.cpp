#include "mcdbn/motion/atomic_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <system_error>

#include "mcdbn/errors.hpp"

namespace mcdbn {

namespace fs = std::filesystem;

void write_file_atomically(const fs::path& path, std::string_view content) {
  // The process id keeps two runs that write the same file from sharing one temporary.
  fs::path temporary = path;
  temporary += fmt::format(".{}.tmp", ::getpid());
  std::error_code error;
  {
    std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
    file.write(content.data(), static_cast<std::streamsize>(content.size()));
    file.close();
    if (!file) {
      fs::remove(temporary, error);
      throw InputError(fmt::format(
          "{}: cannot be written; check that its folder exists, is writable and has room",
          path.string()));
    }
  }
  fs::rename(temporary, path, error);
  if (error) {
    const std::string reason = error.message();
    fs::remove(temporary, error);
    throw InputError(fmt::format("{}: cannot be put in place ({}); choose another output path",
                                 path.string(), reason));
  }
}

}  // namespace mcdbn
