#include "base/text_file.hpp"

#include <doctest/doctest.h>
#include <sys/stat.h>

#include "base/scratch_folder.hpp"
#include "mcdbn/base/errors.hpp"

using namespace mcdbn;

TEST_CASE("write_text_file replaces the file and leaves nothing else behind") {
  const test::ScratchFolder folder;
  const auto path = folder.write("a.txt", "old and longer");
  write_text_file(path, "new\n");
  CHECK(read_text_file(path) == "new\n");
  int entries = 0;
  for (const auto& entry : std::filesystem::directory_iterator(path.parent_path())) {
    entries += entry.exists() ? 1 : 0;
  }
  CHECK(entries == 1);
}

TEST_CASE("write_text_file reports a missing folder and cleans up after a failed rename") {
  const test::ScratchFolder folder;
  CHECK_THROWS_AS(write_text_file(folder / "missing/a.txt", "x"), InputError);
  std::filesystem::create_directories(folder / "taken/inside");
  CHECK_THROWS_AS(write_text_file(folder / "taken", "x"), InputError);
  CHECK(std::filesystem::exists(folder / "taken/inside"));
  int entries = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "")) {
    entries += entry.exists() ? 1 : 0;
  }
  CHECK(entries == 1);
}

TEST_CASE("read_text_file gives every byte, and refuses what is no file") {
  const test::ScratchFolder folder;
  const std::string bytes("a\r\n\0b", 5);
  CHECK(read_text_file(folder.write("a.txt", bytes)) == bytes);
  CHECK(read_text_file(folder.write("empty.txt", "")).empty());
  CHECK_THROWS_AS(read_text_file(folder / "absent.txt"), InputError);
  CHECK_THROWS_AS(read_text_file(folder / ""), InputError);
  // Nobody writes to the pipe: opening it would wait for ever.
  REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
  for (const auto& path : {folder / "pipe", std::filesystem::path("/dev/zero")}) {
    CAPTURE(path);
    CHECK_THROWS_AS(read_text_file(path), InputError);
  }
}

TEST_CASE("read_text_file refuses a file whose bytes cannot be read") {
  // The first page of a process is never mapped, so that reading it is an error of the device.
  try {
    read_text_file("/proc/self/mem");
    FAIL("was read");
  } catch (const InputError& error) {
    CHECK(std::string(error.what()) == "/proc/self/mem: cannot be read to its end");
  }
}
