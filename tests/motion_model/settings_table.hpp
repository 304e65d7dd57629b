#pragma once

// Tables of settings: each name beside the member it stands for and its default.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "mcdbn/base/errors.hpp"
#include "mcdbn/motion_model/training_config.hpp"
#include "mcdbn/motion_model/training_schedule.hpp"

namespace mcdbn::test {

/// A member of any of the types that settings have.
using Member = std::variant<bool*, double*, std::size_t*>;
static_assert(std::is_same_v<std::size_t, std::uint64_t>);

template <typename Value>
Member at(Value& member) {
  return &member;
}

struct Setting {
  const char* name;
  Member (*member)(TrainingConfig&);
  const char* default_value;
};

/// Name and value of settings, the values as text.
using Values = std::map<std::string, std::string>;

inline Values values_of(const TrainingConfig& config) {
  Values values;
  visit_settings(config, [&](const std::string& name, const auto& value, const char*) {
    CHECK(values.count(name) == 0);
    values[name] = fmt::format("{}", value);
  });
  return values;
}

/// What differs from the defaults.
inline Values changed_by(const TrainingConfig& config) {
  const Values defaults = values_of(TrainingConfig{});
  Values changed;
  for (const auto& [name, value] : values_of(config))
    if (defaults.at(name) != value) changed[name] = value;
  return changed;
}

/// Sets one setting through the list, by its name.
inline void set(TrainingConfig& config, const std::string& wanted, double value) {
  int found = 0;
  visit_settings(config, [&](const std::string& name, auto& member, const char*) {
    if (name != wanted) return;
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

/// Each setting of the table is listed by its name with some help, starts at its default, and what
/// is set by that name is that member, and nothing else.
inline void check_settings(const std::vector<Setting>& settings) {
  const Values defaults = values_of(TrainingConfig{});
  for (const Setting& setting : settings) {
    INFO(setting.name);
    REQUIRE(defaults.count(setting.name) == 1);
    TrainingConfig config;
    const Member member = setting.member(config);
    CHECK(text_of(member) == setting.default_value);
    const std::string before = text_of(member);
    const bool is_flag = std::holds_alternative<bool*>(member);
    set(config, setting.name, is_flag ? before == "false" : other_value(member));
    CHECK(text_of(member) != before);
    CHECK(changed_by(config) == Values{{setting.name, text_of(member)}});
    for (const Setting& other : settings)
      if (&other != &setting) {
        INFO(other.name);
        CHECK(text_of(other.member(config)) == other.default_value);
      }
  }
  const TrainingConfig config;
  visit_settings(config, [](const std::string& name, const auto&, const std::string& help) {
    INFO(name);
    CHECK(help.size() > 5);
  });
}

/// Settings whose names begin so.
inline std::size_t listed_under(const std::string& prefix) {
  std::size_t count = 0;
  for (const auto& [name, value] : values_of(TrainingConfig{}))
    if (name.rfind(prefix, 0) == 0) ++count;
  return count;
}

/// Refused in the words `name` + `why`.
inline void check_refused(const std::string& name, double value, const std::string& why) {
  INFO(name, " = ", value);
  TrainingConfig config;
  set(config, name, value);
  std::string message = "accepted";
  try {
    config.validate();
  } catch (const ConfigError& error) {
    message = error.what();
  }
  CHECK(message == name + why);
}

inline void check_accepted(const std::string& name, double value) {
  INFO(name, " = ", value);
  TrainingConfig config;
  set(config, name, value);
  CHECK_NOTHROW(config.validate());
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
