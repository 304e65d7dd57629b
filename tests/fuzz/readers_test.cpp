// Every reader on its seeds, on what fuzzing found, and on damaged copies of both.
#include "fuzz/readers.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <exception>
#include <nlohmann/json.hpp>

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

TEST_CASE("readers: what nests without end is refused, not followed") {
  constexpr std::size_t kDeep = 300'000;
  const auto repeated = [](const std::string& text) {
    std::string all;
    for (std::size_t i = 0; i < kDeep; ++i) all += text;
    return all;
  };
  const std::string lists = std::string(kDeep, '[') + std::string(kDeep, ']'),
                    objects = repeated("{\"a\":") + "1" + std::string(kDeep, '}'),
                    key = repeated("a.") + "b";
  const auto safetensors = [](const char* entry, const std::string& description) {
    const std::string header =
        nlohmann::json{{"__metadata__", {{entry, description}}}}.dump() + "       ";
    std::string bytes(8, '\0');
    for (std::size_t i = 0; i < 4; ++i) bytes[i] = static_cast<char>(header.size() >> (8 * i));
    return bytes + header;
  };
  for (const Reader& reader : readers()) {
    CAPTURE(reader.name);
    for (const std::string& text :
         {lists, objects, "{\"people\": " + lists + "}", "[clip]\nmatrix = 1\n" + key + " = 1\n",
          "[" + key + "]\nmatrix = 1\n", "matrix = {" + key + " = [1]}\n", "x = " + lists + "\n",
          safetensors("mcdbn-checkpoint", "{\"format_version\": " + lists + "}"),
          std::string("HIERARCHY\n") + repeated("JOINT a\n{\n")})
      CHECK(finding(reader, text) == "");
  }
}
