#include "base/output_file.hpp"

#include <fmt/format.h>
#include <linux/magic.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {

namespace fs = std::filesystem;

namespace {

/// The path, and where its links lead one after the other; the last may not exist yet.
std::vector<fs::path> links_from(const fs::path& path) {
  constexpr int kMostLinks = 40;  // as Linux follows
  std::vector<fs::path> chain{path};
  std::error_code error;
  for (int i = 0; i < kMostLinks && fs::is_symlink(fs::symlink_status(chain.back(), error)); ++i) {
    const fs::path target = fs::read_symlink(chain.back(), error);
    if (error) break;
    chain.push_back(chain.back().parent_path() / target);
  }
  return chain;
}

fs::path followed(const fs::path& path) {
  return links_from(path).back();
}

/// Whether it ends in a slash.
bool names_folder(const fs::path& path) {
  return !path.empty() && path.filename().empty();
}

fs::path without_slash(const fs::path& path) {
  return names_folder(path) ? path.parent_path() : path;
}

bool is_in_proc(const fs::path& path) {
  const fs::path folder = path.parent_path().empty() ? "." : path.parent_path();
  struct statfs system {};
  return ::statfs(folder.c_str(), &system) == 0 && system.f_type == PROC_SUPER_MAGIC;
}

/// Whether a link leads to what a program holds open, as /dev/stdout and /dev/fd/3 do: who opened
/// it goes on writing to it, not to a new file of its name.
bool is_held_open(const fs::path& path) {
  return std::ranges::any_of(links_from(path), is_in_proc);
}

/// Short, so that any name that fits its folder can be written.
fs::path temporary_beside(const fs::path& place) {
  static int count = 0;
  return place.parent_path() /
         fmt::format(".mcdbn-{}-{}{}", ::getpid(), ++count, place.extension().string());
}

/// The full path, whether it exists or not.
fs::path place_of(const fs::path& path) {
  std::error_code error;
  return fs::weakly_canonical(fs::absolute(path, error), error);
}

/// A file cannot take the place of a folder, not even of an empty one.
void refuse_folder(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error))
    throw InputError(fmt::format("{}: is a folder; name a file", path.string()));
  if (names_folder(path))
    throw InputError(
        fmt::format("{}: names a folder, by the slash at its end; name a file", path.string()));
}

[[noreturn]] void fail_twice(const fs::path& path) {
  throw InputError(fmt::format("{}: would be written twice; give another name", path.string()));
}

void move(const fs::path& temporary, const fs::path& place) {
  std::error_code error;
  fs::rename(temporary, place, error);
  if (error)
    throw InputError(fmt::format("{}: cannot be replaced: {}", place.string(), error.message()));
}

}  // namespace

std::string_view kind_of(fs::file_type type) {
  switch (type) {
    case fs::file_type::block:
    case fs::file_type::character:
      return "a device";
    case fs::file_type::fifo:
      return "a pipe";
    case fs::file_type::socket:
      return "a socket";
    default:
      return "no file";
  }
}

thread_local OutputBatch* OutputBatch::current = nullptr;

std::optional<OutputBatch::FileIdentity> OutputBatch::identity_of(const fs::path& path) {
  struct stat found {};
  if (::stat(path.c_str(), &found) != 0) return {};
  return FileIdentity{found.st_dev, found.st_ino};
}

void note_input(const fs::path& path) {
  if (OutputBatch* batch = OutputBatch::current)
    if (const auto identity = OutputBatch::identity_of(path)) batch->inputs_.insert(*identity);
}

void check_replaceable(const fs::path& path) {
  std::error_code error;
  const fs::file_type type = fs::status(path, error).type();
  if (type == fs::file_type::not_found) return;
  if (type == fs::file_type::none)
    throw InputError(fmt::format("{}: cannot be written: {}", path.string(), error.message()));
  if (type == fs::file_type::directory) {
    if (!fs::is_empty(path, error))
      throw InputError(
          fmt::format("{}: is a folder with files in it; give another name", path.string()));
  } else if (type != fs::file_type::regular) {
    throw InputError(
        fmt::format("{}: is {}, which is not replaced; name a file", path.string(), kind_of(type)));
  } else if (is_held_open(path)) {
    throw InputError(
        fmt::format("{}: is an open file, which is not replaced; name a file", path.string()));
  }
  const OutputBatch* batch = OutputBatch::current;
  const auto identity = OutputBatch::identity_of(path);
  if (batch != nullptr && identity && batch->inputs_.count(*identity) > 0)
    throw InputError(
        fmt::format("{}: is read, so it cannot be written; give another name", path.string()));
}

OutputFile::OutputFile(const fs::path& path)
    : named_(path), path_(followed(without_slash(path))), temporary_(temporary_beside(path_)) {
  // Checks the path as it was given: a link of the system's own, /dev/stdout, leads to no name.
  check_replaceable(path);
}

OutputFile::~OutputFile() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
}

void OutputFile::put_in_place() {
  if (!fs::is_directory(temporary_)) refuse_folder(named_);
  if (OutputBatch* batch = OutputBatch::current) {
    if (!batch->places_.insert(place_of(path_)).second) fail_twice(path_);
    batch->waiting_.push_back({temporary_, path_});
  } else {
    move(temporary_, path_);
  }
  temporary_.clear();
}

OutputBatch::OutputBatch(const std::vector<fs::path>& inputs) {
  current = this;
  std::ranges::for_each(inputs, note_input);
}

OutputBatch::~OutputBatch() {
  current = nullptr;
  std::error_code ignored;
  for (const Waiting& waiting : waiting_) fs::remove_all(waiting.temporary, ignored);
  // Folders with something in them stay.
  std::for_each(made_folders_.rbegin(), made_folders_.rend(),
                [&](const fs::path& folder) { fs::remove(folder, ignored); });
}

void OutputBatch::put_in_place() {
  for (const Waiting& waiting : waiting_) move(waiting.temporary, waiting.place);
  waiting_.clear();
  made_folders_.clear();
}

void check_output(const fs::path& path, OutputKind kind) {
  check_replaceable(path);
  if (kind == OutputKind::file) refuse_folder(path);
  if (path.empty()) throw InputError("an output without a name; name a file");
  if (path == "-")
    throw InputError("-: standard output is not written to; a file of that name is ./-");
  const fs::path place = followed(without_slash(path)), parent = place.parent_path(),
                 folder = parent.empty() ? "." : parent;
  std::error_code error;
  if (names_folder(path) && fs::exists(place, error) && !fs::is_directory(place, error))
    throw InputError(fmt::format("{}: is no folder; give another name", path.string()));
  if (!fs::is_directory(folder, error))
    throw InputError(fmt::format("{}: cannot be written: there is no folder {}", path.string(),
                                 folder.string()));
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    throw InputError(fmt::format("{}: cannot be written: its folder: {}", path.string(),
                                 std::generic_category().message(errno)));
  OutputBatch* batch = OutputBatch::current;
  if (batch != nullptr && !batch->checked_.insert(place_of(place)).second) fail_twice(path);
}

fs::path make_temporary_folder() {
  std::error_code error;
  std::string pattern = (fs::temp_directory_path(error) / "mcdbn-cl-XXXXXX").string();
  return !error && ::mkdtemp(pattern.data()) != nullptr ? fs::path(pattern) : fs::path();
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  const fs::path place = followed(without_slash(folder));
  if (OutputBatch* batch = OutputBatch::current) {
    std::vector<fs::path> missing;  // the deepest first
    for (fs::path at = place; !at.empty() && !fs::exists(fs::symlink_status(at, error));
         at = at.parent_path())
      missing.push_back(at);
    batch->made_folders_.insert(batch->made_folders_.end(), missing.rbegin(), missing.rend());
  }
  fs::create_directories(place, error);
  if (error)
    throw InputError(
        fmt::format("{}: the folder cannot be made: {}", folder.string(), error.message()));
}

}  // namespace mcdbn
