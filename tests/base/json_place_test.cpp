// Places in JSON: what their messages name, and what they take to remember it.
#include "base/json_place.hpp"

#include <doctest/doctest.h>
#include <malloc.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mcdbn/base/errors.hpp"

using namespace mcdbn;

namespace json_place_test {

namespace {

double bytes_in_use() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}

}  // namespace

TEST_CASE("JSON places: a message names the path, of a long one its end") {
  nlohmann::json content = nlohmann::json::parse(R"({"a": [{"b": "text"}]})");
  content[std::string(300, 'x')] = {1, 2};
  const JsonPlace top(content, "a.json");
  CHECK(top.where() == "a.json");
  CHECK(top["a"].at(0)["b"].where() == "a.json: a[0].b");
  CHECK_THROWS_WITH_AS(top["a"].at(0)["b"].number(),
                       "a.json: a[0].b: a text where a number is expected", InputError);
  CHECK(top[std::string(300, 'x')].at(1).where() == "a.json: ..." + std::string(97, 'x') + "[1]");
}

TEST_CASE("JSON places: those of a long list under a long key are small") {
  constexpr std::size_t kValues = 1000, kKeyBytes = 50'000, kMostBytesOfPlace = 1000;
  const std::string key(kKeyBytes, 'x');
  const nlohmann::json content{{key, std::vector<int>(kValues, 7)}};
  const double before = bytes_in_use();
  const std::vector<JsonPlace> places = JsonPlace(content, "a.json")[key].list();
  const double taken = bytes_in_use() - before;
  REQUIRE(places.size() == kValues);
  CHECK(places.back().number() == 7);
  CHECK(taken < static_cast<double>(kValues * kMostBytesOfPlace));
}

}  // namespace json_place_test
