#include "base/toml_keys.hpp"

#include <doctest/doctest.h>

#include <string>

using namespace mcdbn;

namespace {

/// a.a.a.b of so many dots.
std::string key(int dots, const std::string& part = "a") {
  std::string text;
  for (int i = 0; i < dots; ++i) text += part + ".";
  return text + "b";
}

}  // namespace

TEST_CASE("long keys: wherever a key can stand, by its line") {
  const std::string deep = key(100'000);
  CHECK(line_of_long_key(deep + " = 1\n") == 1);
  CHECK(line_of_long_key("x = 1\n[" + deep + "]\n") == 2);
  CHECK(line_of_long_key("x = 1\n\n[[" + deep + "]]\n") == 3);
  CHECK(line_of_long_key("x = {y = 1, " + deep + " = 1}") == 1);
  CHECK(line_of_long_key(key(100, "\"a=b\"") + " = 1") == 1);
  CHECK(line_of_long_key(key(100, "'#'") + " = 1") == 1);
  CHECK(line_of_long_key(key(100, " a ") + " = 1") == 1);
  CHECK(line_of_long_key(key(17) + " = 1") == 1);
}

TEST_CASE("long keys: nothing else is one") {
  CHECK(!line_of_long_key(key(16) + " = 1\n" + key(16) + " = 2"));
  std::string numbers = "x = [0.5";
  for (int i = 0; i < 100; ++i) numbers += ", 0.5";
  CHECK(!line_of_long_key(numbers + "]"));
  const std::string dots(100, '.');
  for (const std::string& text :
       {"# " + dots, "x = \"" + dots + "\"", "x = '" + dots + "'", "x = \"\\\"" + dots + "\"",
        "x = \"\"\"\n\"" + dots + "\n\"\"\"", "x = '''\n'" + dots + "\n'''",
        "x = \"\"\"a\"\"\"\"\"\ny = '" + dots + "'", std::string("x = \"")})
    CHECK(!line_of_long_key(text));
}

TEST_CASE("long keys: strings end where TOML ends them, so that no key hides behind one") {
  const std::string deep = key(100) + " = 1";
  for (const std::string text : {"x = \"\\\\\"\n", "x = ''''a'''''\n", "x = \"\"\"a\\\"\"\"\"\n",
                                 "x = \"\"\n", "x = ''\n", "x = '\\'\n"}) {
    CAPTURE(text);
    CHECK(line_of_long_key(text + deep) == 2);
  }
  CHECK(line_of_long_key("x = {y = \"\"\" \" \"\"\", " + deep + "}") == 1);
}
