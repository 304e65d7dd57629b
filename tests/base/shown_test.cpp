// Input in messages: cut, and nothing in it that a terminal would obey.

#include "base/shown.hpp"

#include <doctest/doctest.h>

using namespace mcdbn;

TEST_CASE("shown: input stands in quotes, at most its beginning") {
  CHECK(shown("Hips") == "'Hips'");
  CHECK(shown("") == "''");
  CHECK(shown("say \"it\" \\ 'so'") == "'say \"it\" \\ 'so''");
  CHECK(shown("H\xC3\xBC"
              "fte") ==
        "'H\xC3\xBC"
        "fte'");
  CHECK(shown(std::string(40, 'a')) == "'" + std::string(40, 'a') + "'");
  CHECK(shown(std::string(10'000, 'a')) == "'" + std::string(40, 'a') + "...'");
}

TEST_CASE("shown: control bytes are escaped, what is no UTF-8 replaced") {
  CHECK(shown("a\x1B[31mb\x7F") == "'a\\x1b[31mb\\x7f'");
  CHECK(shown(std::string_view("a\0b", 3)) == "'a\\x00b'");
  CHECK(shown("a\nb\tc") == "'a b\\x09c'");
  CHECK(shown("\xFFz") == "'\xEF\xBF\xBDz'");
  CHECK(printable("first\nsecond \x07") == "first\nsecond \\x07");
}
