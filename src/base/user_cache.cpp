#include "base/user_cache.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace mcdbn {
namespace {

namespace fs = std::filesystem;

std::optional<fs::path> cache_folder() {
  // Unset, empty and relative are one, as freedesktop.org's rules have it.
  const auto absolute = [](const char* variable) {
    const char* folder = std::getenv(variable);
    return folder == nullptr || !fs::path(folder).is_absolute() ? fs::path() : fs::path(folder);
  };
  if (const fs::path folder = absolute("XDG_CACHE_HOME"); !folder.empty())
    return folder / "mcdbn-cl";
  if (const fs::path home = absolute("HOME"); !home.empty()) return home / ".cache" / "mcdbn-cl";
  return std::nullopt;
}

std::optional<fs::path> entry_path(const std::string& kind, const std::string& key) {
  const auto folder = cache_folder();
  if (!folder) return std::nullopt;
  return *folder / fmt::format("{}-{:016x}.bin", kind, fnv1a(key));
}

/// Beginning of an entry of this key and value.
std::string header(const std::string& key, const std::string& value) {
  // Hashed behind a line end, unlike for the file's name: else the two hashes would be the same.
  return fmt::format("mcdbn-cl cache 2 {:016x} {} {:016x}\n", fnv1a('\n' + key), value.size(),
                     fnv1a(value));
}

}  // namespace

std::uint64_t fnv1a(const std::string& text) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const unsigned char byte : text) hash = (hash ^ byte) * 1099511628211ULL;
  return hash;
}

std::optional<std::string> read_cache_entry(const std::string& kind, const std::string& key) {
  const auto path = entry_path(kind, key);
  if (!path) return std::nullopt;
  std::ifstream stream(*path, std::ios::binary);
  std::string first_line;
  if (!stream || !std::getline(stream, first_line)) return std::nullopt;
  std::ostringstream rest;
  rest << stream.rdbuf();
  std::string value = rest.str();
  if (first_line + '\n' != header(key, value)) return std::nullopt;
  return value;
}

bool write_cache_entry(const std::string& kind, const std::string& key, const std::string& value) {
  const auto path = entry_path(kind, key);
  if (!path) return false;
  std::error_code error, ignored;
  fs::create_directories(path->parent_path(), ignored);
  const fs::path temporary = path->string() + fmt::format(".{}", ::getpid());
  std::ofstream stream(temporary, std::ios::binary);
  stream << header(key, value) << value;
  stream.close();  // a full disk may show only here
  if (stream) {
    fs::rename(temporary, *path, error);
    if (!error) return true;
  }
  fs::remove(temporary, ignored);
  return false;
}

}  // namespace mcdbn
