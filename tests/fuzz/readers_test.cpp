// Every reader on its seeds, on what fuzzing found, and on damaged copies of both.
#include "fuzz/readers.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <exception>

#include "base/text_file.hpp"
#include "fuzz/mutated.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

namespace fs = std::filesystem;

const fs::path kFolder = fs::path(MCDBN_SOURCE_DIR) / "tests/fuzz";

/// The files of a reader, in their order; none where it has no such folder.
std::vector<fs::path> files_of(const char* kind, const Reader& reader) {
  std::vector<fs::path> files;
  if (const fs::path folder = kFolder / kind / reader.name; fs::is_directory(folder))
    for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

/// What came out of the reader that should not have; empty if nothing did.
std::string finding(const Reader& reader, const std::string& bytes) {
  try {
    refusal(reader, bytes);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("readers: each has seeds, and reads them") {
  for (const Reader& reader : readers()) {
    CAPTURE(reader.name);
    const auto seeds = files_of("seeds", reader);
    CHECK(!seeds.empty());
    for (const fs::path& seed : seeds) CHECK(refusal(reader, read_text_file(seed)) == "");
  }
}

TEST_CASE("readers: what fuzzing found stays found") {
  for (const Reader& reader : readers())
    for (const fs::path& file : files_of("findings", reader)) {
      CAPTURE(file.string());
      CHECK(finding(reader, read_text_file(file)) == "");
    }
}

TEST_CASE("readers: damaged copies of the seeds are read or refused in words of our own") {
  constexpr int kCopies = 150;
  std::mt19937 random(32);
  for (const Reader& reader : readers()) {
    CAPTURE(reader.name);
    int refused = 0;
    for (const fs::path& seed : files_of("seeds", reader)) {
      const std::string text = read_text_file(seed);
      for (int copy = 0; copy < kCopies; ++copy) {
        const std::string damaged = mutated(text, random);
        CAPTURE(seed.string());
        CAPTURE(copy);
        const std::string found = finding(reader, damaged);
        CHECK(found == "");
        if (found.empty()) refused += !refusal(reader, damaged).empty();
      }
    }
    CHECK(refused > 0);
  }
}
