#include "base/folder_lock.hpp"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <ctime>
#include <system_error>
#include <utility>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

namespace fs = std::filesystem;

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

/// `process 12 on HOST since 2026-11-23 20:15:00 UTC`
std::string about_this_process() {
  return fmt::format("process {} on {} since {:%Y-%m-%d %H:%M:%S} UTC\n", ::getpid(), host_name(),
                     fmt::gmtime(std::time(nullptr)));
}

std::string content_of(int file) {
  std::array<char, 1024> text{};
  const ssize_t length = ::pread(file, text.data(), text.size(), 0);
  const std::string all(text.data(), length > 0 ? static_cast<std::size_t>(length) : 0);
  return all.substr(0, all.find('\n'));
}

/// Whether the path still leads to the open file: another program may have removed it meanwhile.
bool is_still_at(const fs::path& path, int file) {
  struct stat open {
  }, named{};
  return ::fstat(file, &open) == 0 && ::stat(path.c_str(), &named) == 0 &&
         open.st_dev == named.st_dev && open.st_ino == named.st_ino;
}

[[noreturn]] void refuse(const fs::path& path, const std::string& owner, const char* advice) {
  throw Error(fmt::format("{}: in use by {}{}", path.parent_path().string(),
                          owner.empty() ? "another process" : owner, advice));
}

}  // namespace

FolderLock::FolderLock(const fs::path& folder) : path_(folder / "lock") {
  do {
    if (file_ >= 0) ::close(file_);
    constexpr mode_t kEverybodyReads = 0644;
    file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, kEverybodyReads);
    if (file_ < 0)
      throw InputError(fmt::format("{}: cannot be written: {}", path_.string(),
                                   std::generic_category().message(errno)));
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
      const std::string owner = content_of(file_);
      ::close(std::exchange(file_, -1));
      refuse(path_, owner, "");
    }
  } while (!is_still_at(path_, file_));
  const std::string owner = content_of(file_);
  if (!owner.empty() &&
      owner.find(fmt::format(" on {} since ", host_name())) == std::string::npos) {
    ::close(std::exchange(file_, -1));
    refuse(path_, owner,
           ", which cannot be asked from here whether it still runs; if not, delete the file lock");
  }
  const std::string about = about_this_process();
  if (::ftruncate(file_, 0) != 0 ||
      ::pwrite(file_, about.data(), about.size(), 0) != static_cast<ssize_t>(about.size())) {
    // On a full disk the lock holds all the same; only the others' message is shorter.
  }
}

FolderLock::FolderLock(FolderLock&& other) noexcept
    : path_(std::move(other.path_)), file_(std::exchange(other.file_, -1)) {}

FolderLock::~FolderLock() {
  if (file_ < 0) return;
  ::unlink(path_.c_str());
  ::close(file_);
}

}  // namespace mcdbn
