// For libFuzzer: the reader that READER names is given any bytes (scripts/fuzz).
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "fuzz/readers.hpp"

namespace {

const mcdbn::test::Reader& chosen() {
  const char* name = std::getenv("READER");
  for (const mcdbn::test::Reader& reader : mcdbn::test::readers())
    if (name != nullptr && reader.name == name) return reader;
  std::fputs("READER names none of:", stderr);
  for (const mcdbn::test::Reader& reader : mcdbn::test::readers())
    std::fprintf(stderr, " %s", reader.name.c_str());
  std::fputs("\n", stderr);
  std::exit(2);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const mcdbn::test::Reader& reader = chosen();
  mcdbn::test::refusal(reader, {reinterpret_cast<const char*>(data), size});
  return 0;
}
