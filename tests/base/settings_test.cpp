#include "mcdbn/base/settings.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "base/setting_values.hpp"
#include "base/settings_table.hpp"
#include "mcdbn/base/errors.hpp"

using namespace mcdbn;
using namespace mcdbn::test;
using nlohmann::json;

namespace {

struct Inner {
  double share = 0.5;
  bool flag = true;

  template <typename Self, typename Visit>
  static void visit(Self& self, const Visit& visit) {
    visit(Setting{"share", share_below_one(), "", "some"}, self.share);
    visit(Setting{"flag", on_or_off(), "", "or not"}, self.flag);
  }
};

struct Outer {
  std::size_t count = 3;
  Inner inner;

  template <typename Self, typename Visit>
  static void visit(Self& self, const Visit& visit) {
    visit(Setting{"count", at_least(2), "things", "how many"}, self.count);
    visit_group("inner", self.inner, visit);
  }
};

template <typename Member>
std::string assigned(const Range& range, const json& value, Member& member) {
  try {
    assign_value("it", {"name", range, "", ""}, value, member);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "ok";
}

}  // namespace

TEST_CASE("settings: ranges and their words") {
  struct Case {
    Range range;
    std::vector<double> in, out;
    const char* text;
  };
  const double tiny = std::numeric_limits<double>::denorm_min();
  for (const Case& one : std::vector<Case>{
           {any_number(), {-1e300, 0, 1e300}, {}, "a finite number"},
           {at_least(2), {2, kLargest}, {1.999, -3, 1e300}, "at least 2 and at most 1000000000"},
           {above(0), {tiny, 5}, {0, -0.0, -tiny, 1e300}, "above 0 and at most 1000000000"},
           {within(-1, 1), {-1, 0, 1}, {-1.01, 1.01}, "at least -1 and at most 1"},
           {between(0, 180), {tiny, 179.9}, {0, 180, 200}, "above 0 and below 180"},
           {share_below_one(), {0, 0.999}, {-tiny, 1}, "at least 0 and below 1"},
           {Range{.most = 4}, {-9, 4}, {4.1}, "at most 4"}}) {
    CAPTURE(one.text);
    CHECK(one.range.text() == one.text);
    for (const double value : one.in) CHECK(one.range.contains(value));
    for (const double value : one.out) CHECK_FALSE(one.range.contains(value));
    for (const double value : {kNan, kInfinity, -kInfinity}) CHECK_FALSE(one.range.contains(value));
  }
}

TEST_CASE("settings: groups are named before their settings, and checked by that name") {
  CHECK(values_of(Outer{}) ==
        Values{{"count", "3"}, {"inner.share", "0.5"}, {"inner.flag", "true"}});
  CHECK_NOTHROW(check_settings(Outer{}));
  check_refused<Outer>("count", 1, "at least 2 and at most 1000000000");
  check_refused<Outer>("inner.share", 1, "at least 0 and below 1");
  check_refused<Outer>("inner.share", -kInfinity, "a finite number");
}

TEST_CASE("settings: a value is of its setting's kind and range, or refused") {
  std::size_t count = 7;
  CHECK(assigned(at_least(2), 5, count) == "ok");
  CHECK(count == 5);
  CHECK(assigned(at_least(2), -3, count) == "it must be at least 2 and at most 1000000000, not -3");
  CHECK(assigned(any_number(), -3, count) == "it must be at least 0, not -3");
  CHECK(assigned(at_least(2), 2.0, count) == "it must be a whole number, not 2.0");
  CHECK(assigned(at_least(2), true, count) == "it must be a whole number, not true");
  CHECK(assigned(at_least(2), "two", count) == "it must be a whole number, not \"two\"");
  CHECK(count == 5);
  CHECK(assigned(any_seed(), std::size_t{9'000'000'000'000'000'000}, count) == "ok");
  CHECK(count == 9'000'000'000'000'000'000);
  CHECK(assigned(any_seed(), std::numeric_limits<std::size_t>::max(), count) != "ok");
  double number = 7;
  CHECK(assigned(above(0), 3, number) == "ok");
  CHECK(number == 3);
  CHECK(assigned(above(0), 0.0, number) == "it must be above 0 and at most 1000000000, not 0");
  CHECK(assigned(above(0), false, number) == "it must be a number, not false");
  bool flag = false;
  CHECK(assigned(on_or_off(), true, flag) == "ok");
  CHECK(flag);
  CHECK(assigned(on_or_off(), 0, flag) == "it must be true or false, not 0");
}

TEST_CASE("settings: the number that a text is") {
  CHECK(number_in("12") == json(12U));
  CHECK(number_in("18446744073709551615").get<std::uint64_t>() ==
        std::numeric_limits<std::uint64_t>::max());
  CHECK(number_in("-3") == json(-3));
  CHECK(number_in("-3").is_number_integer());
  CHECK(number_in(".5") == json(0.5));
  CHECK(number_in("1e-3") == json(1e-3));
  CHECK(number_in("3.0").is_number_float());
  for (const char* text : {"", "minus", "3x", "0x10", "1,5", "3 "})
    CHECK(number_in(text) == json(text));
}

TEST_CASE("settings: a record is nested at the dots") {
  CHECK(settings_record(Outer{}) ==
        json{{"count", 3}, {"inner", {{"share", 0.5}, {"flag", true}}}});
  CHECK(json{{"a", {{"b-c", 4}}}}.at(record_pointer("a.b-c")) == 4);
}
