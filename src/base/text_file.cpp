#include "base/text_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <sstream>
#include <system_error>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {

namespace fs = std::filesystem;

std::string read_text_file(const fs::path& path) {
  // A folder opens like a file on Linux and then reads as empty.
  if (fs::is_directory(path)) {
    throw InputError(fmt::format("{}: is a folder, name a file in it", path.string()));
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream) {
    throw InputError(fmt::format("{}: cannot be opened, check its name and rights", path.string()));
  }
  std::ostringstream text;
  text << stream.rdbuf();
  if (stream.bad()) throw InputError(fmt::format("{}: cannot be read to its end", path.string()));
  return std::move(text).str();
}

void write_text_file(const fs::path& path, std::string_view text) {
  const fs::path temporary = fmt::format("{}.{}.tmp", path.string(), ::getpid());
  std::error_code error;
  {
    std::ofstream stream(temporary, std::ios::binary);
    stream.write(text.data(), static_cast<std::streamsize>(text.size()));
    stream.close();
    if (!stream) {
      fs::remove(temporary, error);
      throw InputError(fmt::format(
          "{}: cannot be written, check that its folder exists and has room", path.string()));
    }
  }
  fs::rename(temporary, path, error);
  if (error) {
    const std::string reason = error.message();
    fs::remove(temporary, error);
    throw InputError(fmt::format("{}: cannot be replaced: {}", path.string(), reason));
  }
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw InputError(
        fmt::format("{}: the folder cannot be made: {}", folder.string(), error.message()));
}

}  // namespace mcdbn
