#include "mcdbn/motion/atomic_file.hpp"

#include <doctest/doctest.h>

#include "mcdbn/errors.hpp"
#include "motion/scratch_folder.hpp"

using namespace mcdbn;

TEST_CASE("write_file_atomically replaces the file and leaves nothing else behind") {
  const test::ScratchFolder folder;
  const auto path = folder.write("a.txt", "old and longer");
  write_file_atomically(path, "new\n");
  CHECK(test::ScratchFolder::text_of(path) == "new\n");
  int entries = 0;
  for (const auto& entry : std::filesystem::directory_iterator(path.parent_path())) {
    entries += entry.exists() ? 1 : 0;
  }
  CHECK(entries == 1);
}

TEST_CASE("write_file_atomically reports a missing folder and cleans up after a failed rename") {
  const test::ScratchFolder folder;
  CHECK_THROWS_AS(write_file_atomically(folder / "missing/a.txt", "x"), InputError);
  std::filesystem::create_directories(folder / "taken/inside");
  CHECK_THROWS_AS(write_file_atomically(folder / "taken", "x"), InputError);
  CHECK(std::filesystem::exists(folder / "taken/inside"));
  int entries = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "")) {
    entries += entry.exists() ? 1 : 0;
  }
  CHECK(entries == 1);
}
