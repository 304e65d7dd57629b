#include "base/folder_lock.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>

#include "base/scratch_folder.hpp"
#include "base/text_file.hpp"
#include "mcdbn/base/errors.hpp"

using namespace mcdbn;
namespace fs = std::filesystem;

namespace {

std::string host() {
  std::array<char, 256> name{};
  REQUIRE(::gethostname(name.data(), name.size() - 1) == 0);
  return name.data();
}

std::string refusal(const fs::path& folder) {
  try {
    const FolderLock lock(folder);
    return {};
  } catch (const Error& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("a folder is locked for one process at a time, which is named") {
  const test::ScratchFolder folder;
  {
    const FolderLock lock(folder / "");
    const std::string owner = fmt::format("process {} on {} since 20", ::getpid(), host());
    CHECK(read_text_file(folder / "lock").starts_with(owner));
    CHECK(refusal(folder / "").find(owner) != std::string::npos);
    CHECK(fs::exists(folder / "lock"));
  }
  CHECK(!fs::exists(folder / "lock"));
  CHECK(refusal(folder / "").empty());
  CHECK_THROWS_AS(FolderLock(folder / "absent"), InputError);
}

TEST_CASE("a lock whose process was killed, or whose number another has, is taken over") {
  const test::ScratchFolder folder;
  const pid_t child = ::fork();
  if (child == 0) {
    const FolderLock lock(folder / "");
    ::raise(SIGKILL);
  }
  REQUIRE(child > 0);
  ::waitpid(child, nullptr, 0);
  CHECK(read_text_file(folder / "lock").starts_with(fmt::format("process {} on ", child)));
  CHECK(refusal(folder / "").empty());

  // Process 1 lives, but it is another one than wrote this.
  folder.write("lock", fmt::format("process 1 on {} since 2001-01-01 00:00:00 UTC\n", host()));
  CHECK(refusal(folder / "").empty());
  folder.write("lock", "");
  CHECK(refusal(folder / "").empty());
}

TEST_CASE("a lock of another host is left to people") {
  const test::ScratchFolder folder;
  folder.write("lock", "process 7 on another-host since 2026-01-01 00:00:00 UTC\n");
  const std::string message = refusal(folder / "");
  CHECK(message.find("process 7 on another-host since 2026-01-01 00:00:00 UTC") !=
        std::string::npos);
  CHECK(message.find("delete the file lock") != std::string::npos);
  CHECK(fs::exists(folder / "lock"));
}
