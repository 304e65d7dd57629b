#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "base/setting_values.hpp"

namespace mcdbn::cli {

/// "--gaussian-rate" of "gaussian.rate".
std::string flag_of(const std::string& setting);

/// A message of the library for users of flags: `gaussian.rate`, in backquotes, becomes
/// --gaussian-rate.
std::string with_flags(const std::string& text);

/// What an option that is no setting may be, for its check(): NaN is in no range.
CLI::Validator in_range(const Range& range);

/// Adds a flag for a number, with the setting's unit, help and range.
/// @param set gets the value and throws ConfigError if it is invalid
CLI::Option* add_number_flag(CLI::App& command, const std::string& flag, const Setting& setting,
                             const std::function<void(const nlohmann::json&)>& set);

/// Adds --flag and --no-flag. @param usual the value if neither is given
CLI::Option* add_switch_flag(CLI::App& command, const std::string& flag, const Setting& setting,
                             bool usual, const std::function<void(const nlohmann::json&)>& set);

/// Adds the flag of a setting that is this member; its value now is the default.
template <typename Member>
CLI::Option* add_setting_flag(CLI::App& command, const std::string& flag, const Setting& setting,
                              Member& member) {
  return add_number_flag(command, flag, setting,
                         [&member, flag, setting](const nlohmann::json& value) {
                           assign_value(flag, setting, value, member);
                         })
      ->default_str(nlohmann::json(member).dump());
}

/// As add_setting_flag() above, for a member that stays unset if the flag is not given.
template <typename Member>
CLI::Option* add_setting_flag(CLI::App& command, const std::string& flag, const Setting& setting,
                              std::optional<Member>& member) {
  return add_number_flag(command, flag, setting,
                         [&member, flag, setting](const nlohmann::json& value) {
                           assign_value(flag, setting, value, member.emplace());
                         });
}

/// A flag for every setting; the member's value is the default.
template <typename Settings>
void add_setting_flags(CLI::App& command, Settings& settings) {
  visit_settings(settings, [&](const Setting& setting, auto& member) {
    const std::string flag = flag_of(setting.name);
    if constexpr (std::is_same_v<std::decay_t<decltype(member)>, bool>)
      add_switch_flag(command, flag, setting, member,
                      [&member](const nlohmann::json& value) { member = value; });
    else
      add_setting_flag(command, flag, setting, member);
  });
}

}  // namespace mcdbn::cli
