#pragma once

// Tables of settings: each name beside the member it stands for and its default.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "mcdbn/base/errors.hpp"
#include "mcdbn/base/settings.hpp"

namespace mcdbn::test {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A member of any of the types that settings have.
using Member = std::variant<bool*, double*, std::size_t*>;
static_assert(std::is_same_v<std::size_t, std::uint64_t>);

template <typename Value>
Member at(Value& member) {
  return &member;
}

/// What a struct's visit() must give for one of its settings.
template <typename Settings>
struct Expected {
  const char* name;
  Member (*member)(Settings&);
  const char* default_value;
};

/// Name and value of settings, the values as text.
using Values = std::map<std::string, std::string>;

template <typename Settings>
Values values_of(const Settings& settings) {
  Values values;
  visit_settings(settings, [&](const Setting& setting, const auto& value) {
    CHECK(values.count(setting.name) == 0);
    values[setting.name] = fmt::format("{}", value);
  });
  return values;
}

/// What differs from the defaults.
template <typename Settings>
Values changed_by(const Settings& settings) {
  const Values defaults = values_of(Settings{});
  Values changed;
  for (const auto& [name, value] : values_of(settings))
    if (defaults.at(name) != value) changed[name] = value;
  return changed;
}

/// Sets one setting through visit(), by its name.
template <typename Settings>
void set(Settings& settings, const std::string& wanted, double value) {
  int found = 0;
  visit_settings(settings, [&](const Setting& setting, auto& member) {
    if (setting.name != wanted) return;
    ++found;
    member = static_cast<std::remove_reference_t<decltype(member)>>(value);
  });
  INFO(wanted);
  REQUIRE(found == 1);
}

inline std::string text_of(const Member& member) {
  return std::visit([](const auto* value) { return fmt::format("{}", *value); }, member);
}

/// Another value than the one it has.
inline double other_value(const Member& member) {
  return std::visit([](const auto* value) { return *value == 0 ? 1.0 : *value / 2.0; }, member);
}

/// The table has all settings of the struct; each has some help, starts at its default, and what is
/// set by its name is that member, and nothing else.
template <typename Settings>
void check_table(const std::vector<Expected<Settings>>& table) {
  CHECK(values_of(Settings{}).size() == table.size());
  for (const Expected<Settings>& row : table) {
    INFO(row.name);
    REQUIRE(values_of(Settings{}).count(row.name) == 1);
    Settings settings;
    const Member member = row.member(settings);
    CHECK(text_of(member) == row.default_value);
    const std::string before = text_of(member);
    const bool is_switch = std::holds_alternative<bool*>(member);
    set(settings, row.name, is_switch ? before == "false" : other_value(member));
    CHECK(text_of(member) != before);
    CHECK(changed_by(settings) == Values{{row.name, text_of(member)}});
    for (const Expected<Settings>& other : table)
      if (&other != &row) {
        INFO(other.name);
        CHECK(text_of(other.member(settings)) == other.default_value);
      }
  }
  const Settings defaults;
  visit_settings(defaults, [](const Setting& setting, const auto& value) {
    INFO(setting.name);
    CHECK(setting.help.size() > 5);
    if (std::is_same_v<std::decay_t<decltype(value)>, bool>) return;
    CHECK(std::isfinite(setting.range.least));
    CHECK(std::isfinite(setting.range.most));
    CHECK_FALSE(setting.range.contains(kNan));
  });
}

/// Settings whose names begin so.
template <typename Settings>
std::size_t listed_under(const std::string& prefix) {
  std::size_t count = 0;
  for (const auto& [name, value] : values_of(Settings{}))
    if (name.starts_with(prefix)) ++count;
  return count;
}

/// Refused in the words "`name` must be `range`, not `value`".
/// @param range its lower end may do
template <typename Settings>
void check_refused(const std::string& name, double value, const std::string& range) {
  INFO(name, " = ", value);
  Settings settings;
  set(settings, name, value);
  std::string message = "accepted";
  try {
    check_settings(settings);
  } catch (const ConfigError& error) {
    message = error.what();
  }
  CHECK(message.starts_with(fmt::format("`{}` must be {}", name, range)));
  CHECK(message.ends_with(fmt::format(", not {}", value)));
}

template <typename Settings>
void check_accepted(const std::string& name, double value) {
  INFO(name, " = ", value);
  Settings settings;
  set(settings, name, value);
  CHECK_NOTHROW(check_settings(settings));
}

/// Becomes a value of any type, for counting what an aggregate can be made of.
struct Anything {
  template <typename Value>
  operator Value() const;  // never defined
};

/// How many members an aggregate has.
template <typename Aggregate, typename... Members>
constexpr std::size_t member_count() {
  if constexpr (requires { Aggregate{Members{}..., Anything{}}; })
    return member_count<Aggregate, Members..., Anything>();
  else
    return sizeof...(Members);
}

}  // namespace mcdbn::test
