#include "base/user_cache.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <iterator>

#include "base/scoped_variable.hpp"
#include "base/scratch_folder.hpp"

namespace user_cache_test {

using namespace mcdbn;
using namespace mcdbn::test;
namespace fs = std::filesystem;

TEST_CASE("user cache: an entry comes back under its kind and key, and under no other") {
  const ScratchFolder folder;
  const ScopedVariable cache("XDG_CACHE_HOME", (folder / "cache").string());
  CHECK(write_cache_entry("kind", "key", "value\n2"));
  CHECK(read_cache_entry("kind", "key") == "value\n2");
  CHECK_FALSE(read_cache_entry("kind", "other"));
  CHECK_FALSE(read_cache_entry("other", "key"));
}

TEST_CASE("user cache: a variable that is empty or relative counts as unset") {
  const ScratchFolder folder;
  const ScopedVariable home("HOME", (folder / "home").string());
  for (const char* value : {"", "beside"}) {
    CAPTURE(value);
    const ScopedVariable cache("XDG_CACHE_HOME", value);
    write_cache_entry("kind", "key", value);
    CHECK(fs::exists(folder / "home/.cache/mcdbn-cl"));
    CHECK_FALSE(fs::exists(fs::path(value) / "mcdbn-cl"));
    CHECK(read_cache_entry("kind", "key") == value);
    const ScopedVariable homeless("HOME", "");
    CHECK_FALSE(read_cache_entry("kind", "key"));
    CHECK_FALSE(write_cache_entry("kind", "key", value));
  }
}

TEST_CASE("user cache: an entry that cannot be written is reported, and nothing is left of it") {
  const ScratchFolder folder;
  {
    const ScopedVariable cache("XDG_CACHE_HOME", folder.write("file", "").string());
    CHECK_FALSE(write_cache_entry("kind", "key", "value"));
  }
  const ScopedVariable cache("XDG_CACHE_HOME", (folder / "cache").string());
  REQUIRE(write_cache_entry("kind", "key", "value"));
  // A folder in the entry's place: the file is written, and cannot be put there.
  const fs::path entries = folder / "cache/mcdbn-cl";
  const fs::path entry = fs::directory_iterator(entries)->path();
  fs::remove(entry);
  fs::create_directories(entry / "within");
  CHECK_FALSE(write_cache_entry("kind", "key", "value"));
  CHECK(std::distance(fs::directory_iterator(entries), fs::directory_iterator()) == 1);
}

}  // namespace user_cache_test
