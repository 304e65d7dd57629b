#include "base/text_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <system_error>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {

namespace fs = std::filesystem;

std::string read_text_file(const fs::path& path) {
  // A folder opens like a file on Linux and then reads as empty.
  std::error_code error;
  const fs::file_type type = fs::status(path, error).type();
  if (type == fs::file_type::directory)
    throw InputError(fmt::format("{}: is a folder, name a file in it", path.string()));
  // A pipe would block until another process writes, and can be read only once.
  if (fs::exists(fs::file_status(type)) && type != fs::file_type::regular)
    throw InputError(fmt::format("{}: is {}, name a file", path.string(), kind_of(type)));
  std::ifstream stream(path, std::ios::binary);
  if (!stream) {
    throw InputError(fmt::format("{}: cannot be opened, check its name and rights", path.string()));
  }
  note_input(path);
  std::string text;
  std::array<char, 1 << 16> block;
  while (stream.read(block.data(), block.size()) || stream.gcount() > 0)
    text.append(block.data(), static_cast<std::size_t>(stream.gcount()));
  if (stream.bad()) throw InputError(fmt::format("{}: cannot be read to its end", path.string()));
  return text;
}

void write_text_file(const fs::path& path, std::string_view text) {
  OutputFile file(path);
  errno = 0;
  std::ofstream stream(file.temporary(), std::ios::binary);
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.close();
  if (!stream)
    throw InputError(
        fmt::format("{}: cannot be written: {}", path.string(),
                    errno != 0 ? std::generic_category().message(errno) : "its folder refused it"));
  file.put_in_place();
}

}  // namespace mcdbn
