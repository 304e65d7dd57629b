#include "base/utf8.hpp"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "mcdbn/base/errors.hpp"

using namespace mcdbn;

TEST_CASE("UTF-8 is what the writer of JSON takes: all pairs of bytes, and longer characters") {
  const auto json_takes = [](const std::string& text) {
    try {
      return !nlohmann::json(text).dump().empty();
    } catch (const nlohmann::json::exception&) {
      return false;
    }
  };
  std::string text(2, '\0');
  for (int first = 0; first < 256; ++first)
    for (int second = 0; second < 256; ++second) {
      text = {static_cast<char>(first), static_cast<char>(second)};
      CHECK(is_utf8(text) == json_takes(text));
      for (const char* end : {"\x80", "\xBF", "\xC0", "\x80\x80", "\xBF\xBF", "\xBF\x7F"})
        CHECK(is_utf8(text + end) == json_takes(text + end));
    }
  CHECK(is_utf8(""));
  CHECK(is_utf8("Hüfte \xF0\x9F\x92\x83"));
  CHECK_THROWS_AS(require_utf8("Hip\xFF", "a.bvh: a joint's name"), InputError);
  CHECK_NOTHROW(require_utf8("Hip", "a.bvh: a joint's name"));
}
