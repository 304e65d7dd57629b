#include "base/setting_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

[[noreturn]] void reject(const std::string& who, const char* kind, const nlohmann::json& value) {
  throw ConfigError(fmt::format("{} must be {}, not {}", who, kind, value.dump()));
}

template <typename Number>
bool is_all(const std::string& text, Number& number) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && stop == end;
}

}  // namespace

void assign_value(const std::string& who, const Setting&, const nlohmann::json& value,
                  bool& member) {
  if (!value.is_boolean()) reject(who, "true or false", value);
  member = value.get<bool>();
}

void assign_value(const std::string& who, const Setting& setting, const nlohmann::json& value,
                  std::size_t& member) {
  if (!value.is_number_integer()) reject(who, "a whole number", value);
  const auto number = value.get<double>();
  check_range(who, setting.range, number);
  check_range(who, Range{.least = 0}, number);  // before it wraps around
  member = value.get<std::size_t>();
}

void assign_value(const std::string& who, const Setting& setting, const nlohmann::json& value,
                  double& member) {
  if (!value.is_number()) reject(who, "a number", value);
  check_range(who, setting.range, value.get<double>());
  member = value.get<double>();
}

nlohmann::json number_in(const std::string& text) {
  if (std::uint64_t count = 0; is_all(text, count)) return count;
  if (std::int64_t whole = 0; is_all(text, whole)) return whole;
  if (double number = 0; is_all(text, number)) return number;
  return text;
}

nlohmann::json::json_pointer record_pointer(const std::string& setting) {
  std::string pointer = "/" + setting;
  std::replace(pointer.begin(), pointer.end(), '.', '/');
  return nlohmann::json::json_pointer(pointer);
}

}  // namespace mcdbn
