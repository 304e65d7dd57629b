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

TEST_CASE("shown: what terminals obey beyond ASCII is escaped, other letters are not") {
  CHECK(printable("a\xC2\x9B"
                  "31mb") == "a\\xc2\\x9b31mb");  // a control sequence in one character
  CHECK(printable("\xC2\x80") == "\\xc2\\x80");
  CHECK(printable("\xC2\xA0\xC2\xB5") == "\xC2\xA0\xC2\xB5");
  CHECK(printable("x\xE2\x80\xAEvhb.y") == "x\\xe2\\x80\\xaevhb.y");  // right to left
  CHECK(printable("\xE2\x81\xA6\xE2\x81\xA9") == "\\xe2\\x81\\xa6\\xe2\\x81\\xa9");
  CHECK(printable("\xE2\x80\xA8") == "\\xe2\\x80\\xa8");
  CHECK(printable("\xE2\x80\xA6 \xE2\x81\xAA") == "\xE2\x80\xA6 \xE2\x81\xAA");
}

TEST_CASE("shown: of a long text its end, in one line") {
  CHECK(printable_end("a\nb\x1b", 4) == "a b\\x1b");
  CHECK(printable_end("walks/of/one.bvh", 7) == "...one.bvh");
}
