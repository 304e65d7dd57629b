#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

#include "base/shown.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/base/given_setting.hpp"
#include "mcdbn/base/settings.hpp"

namespace mcdbn {

/// Gives a member a value that was read: a JSON number, or true or false.
/// @param who stands before "must be" in the error
/// @throws ConfigError if the value is of another kind, or out of the setting's range
void assign_value(const std::string& who, const Setting& setting, const nlohmann::json& value,
                  bool& member);
void assign_value(const std::string& who, const Setting& setting, const nlohmann::json& value,
                  std::size_t& member);
void assign_value(const std::string& who, const Setting& setting, const nlohmann::json& value,
                  double& member);

enum class RangeCheck { on, off };  ///< off: other versions of the program had other ranges

/// Sets the given setting.
/// @throws ConfigError for a setting that does not exist, a value of another kind or out of range
template <typename Settings>
void assign_setting(Settings& settings, const GivenSetting& given,
                    RangeCheck check = RangeCheck::on) {
  bool found = false;
  visit_settings(settings, [&](Setting setting, auto& member) {
    if (setting.name != given.name) return;
    found = true;
    if (check == RangeCheck::off) setting.range = any_number();
    assign_value(given.who, setting, given.value, member);
  });
  if (!found) throw ConfigError(fmt::format("{} is no setting", printable_line(given.who)));
}

/// The number that a text is, the whole of it; a text that is none, as it is.
nlohmann::json number_in(const std::string& text);

/// Where a record, nested at the dots of the names, has a setting.
nlohmann::json::json_pointer record_pointer(const std::string& setting);

/// Every setting of a struct by its name, nested at the dots.
template <typename Settings>
nlohmann::json settings_record(const Settings& settings) {
  nlohmann::json record;
  visit_settings(settings, [&](const Setting& setting, const auto& value) {
    record[record_pointer(setting.name)] = value;
  });
  return record;
}

}  // namespace mcdbn
