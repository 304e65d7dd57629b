#include "base/parsed_json.hpp"

#include <doctest/doctest.h>

#include <string>

using namespace mcdbn;

namespace {

std::string lists(int deep) {
  const auto count = static_cast<std::size_t>(deep);
  return std::string(count, '[') + std::string(count, ']');
}

}  // namespace

TEST_CASE("parsed JSON: values, and nothing of what is none") {
  CHECK(parsed_json(R"({"a": [1, "]]"]})") == nlohmann::json{{"a", {1, "]]"}}});
  CHECK(parsed_json("").is_discarded());
  CHECK(parsed_json("{\"a\": }").is_discarded());
}

TEST_CASE("parsed JSON: what nests deeper than any file of ours is none, however deep") {
  CHECK(!parsed_json(lists(kDeepestJson)).is_discarded());
  CHECK(parsed_json(lists(kDeepestJson + 1)).is_discarded());
  CHECK(parsed_json(lists(1'000'000)).is_discarded());
  CHECK(parsed_json("{\"a\":" + lists(kDeepestJson) + "}").is_discarded());
}

TEST_CASE("nesting is counted outside of strings, side by side once") {
  CHECK(!nests_deeper("[[], [], {}, {}]", 2));
  CHECK(nests_deeper("[[], [{}]]", 2));
  CHECK(!nests_deeper(R"(["[[[", "\"[[[", "\\"])", 1));
  CHECK(nests_deeper(R"(["\\", [[]]])", 2));
}
