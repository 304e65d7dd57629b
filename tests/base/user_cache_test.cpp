#include "base/user_cache.hpp"

#include <doctest/doctest.h>

#include <filesystem>

#include "base/scoped_variable.hpp"
#include "base/scratch_folder.hpp"

namespace user_cache_test {

using namespace mcdbn;
using namespace mcdbn::test;
namespace fs = std::filesystem;

TEST_CASE("user cache: an entry comes back under its kind and key, and under no other") {
  const ScratchFolder folder;
  const ScopedVariable cache("XDG_CACHE_HOME", (folder / "cache").string());
  write_cache_entry("kind", "key", "value\n2");
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
  }
}

}  // namespace user_cache_test
