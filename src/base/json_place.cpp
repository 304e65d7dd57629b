#include "base/json_place.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/shown.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {

using nlohmann::json;

namespace {

constexpr std::size_t kLongestPath = 100;  // that messages show; keys may be of any length

std::string kind_in_words(const json& value) {
  if (value.is_null()) return "nothing (null)";
  if (value.is_boolean()) return "a truth value";
  if (value.is_string()) return "a text";
  if (value.is_array()) return "a list";
  if (value.is_object()) return "an object";
  return "a number";
}

}  // namespace

JsonPlace::JsonPlace(const json& value, const JsonPlace& from, const std::string& step)
    : value_(&value), file_(from.file_), path_(from.path_ + step) {
  // One more than is shown, so that messages tell that it is cut.
  if (path_.size() > kLongestPath) path_ = path_.substr(path_.size() - kLongestPath - 1);
}

std::string JsonPlace::where() const {
  if (path_.empty()) return *file_;
  return fmt::format("{}: {}", *file_, printable_end(path_, kLongestPath));
}

void JsonPlace::fail(const std::string& what) const {
  throw InputError(fmt::format("{}: {}", where(), what));
}

JsonPlace JsonPlace::operator[](const std::string& key) const {
  if (!is_object()) fail(fmt::format("{} where an object is expected", kind_in_words(*value_)));
  const auto found = value_->find(key);
  if (found == value_->end()) fail(fmt::format("no key {}", shown(key)));
  return {*found, *this, path_.empty() ? key : "." + key};
}

JsonPlace JsonPlace::at(std::size_t index) const {
  if (!is_list()) fail(fmt::format("{} where a list is expected", kind_in_words(*value_)));
  if (index >= value_->size()) fail(fmt::format("{} values; more are needed", value_->size()));
  return {(*value_)[index], *this, fmt::format("[{}]", index)};
}

std::vector<JsonPlace> JsonPlace::list() const {
  if (!is_list()) fail(fmt::format("{} where a list is expected", kind_in_words(*value_)));
  std::vector<JsonPlace> places;
  for (std::size_t i = 0; i < value_->size(); ++i) places.push_back(at(i));
  return places;
}

std::vector<std::string> JsonPlace::keys() const {
  if (!is_object()) fail(fmt::format("{} where an object is expected", kind_in_words(*value_)));
  std::vector<std::string> names;
  for (const auto& [key, value] : value_->items()) names.push_back(key);
  return names;
}

double JsonPlace::number() const {
  if (value_->is_null()) return std::numeric_limits<double>::quiet_NaN();
  if (!value_->is_number())
    fail(fmt::format("{} where a number is expected", kind_in_words(*value_)));
  return value_->get<double>();
}

long long JsonPlace::whole_number() const {
  const double value = value_->is_null() ? 0.5 : number();
  if (value != std::floor(value) || std::abs(value) > 1e15) fail("no usable whole number");
  return static_cast<long long>(value);
}

std::string JsonPlace::text() const {
  if (!value_->is_string())
    fail(fmt::format("{} where a text is expected", kind_in_words(*value_)));
  return value_->get<std::string>();
}

std::vector<double> JsonPlace::numbers() const {
  if (!is_list())
    fail(fmt::format("{} where a list of numbers is expected", kind_in_words(*value_)));
  std::vector<double> result;
  result.reserve(value_->size());
  for (std::size_t i = 0; i < value_->size(); ++i) {
    const json& value = (*value_)[i];
    result.push_back(value.is_number() ? value.get<double>() : at(i).number());
  }
  return result;
}

bool JsonPlace::truth() const {
  if (!value_->is_boolean())
    fail(fmt::format("{} where true or false is expected", kind_in_words(*value_)));
  return value_->get<bool>();
}

double JsonPlace::number(const Range& range) const {
  const double value = number();
  if (!range.contains(value)) fail(fmt::format("must be {}, not {}", range.text(), value));
  return value;
}

std::size_t JsonPlace::count(const Range& range) const {
  if (!value_->is_number_integer())
    fail(fmt::format("{} where a whole number is expected", kind_in_words(*value_)));
  number(range);
  return value_->get<std::size_t>();
}

std::vector<double> JsonPlace::finite_numbers() const {
  std::vector<double> values = numbers();
  constexpr Range kUsable = within(-kLargest, kLargest);
  const auto odd =
      std::ranges::find_if(values, [&](double value) { return !kUsable.contains(value); });
  if (odd != values.end()) at(static_cast<std::size_t>(odd - values.begin())).number(kUsable);
  return values;
}

std::vector<std::string> JsonPlace::texts() const {
  std::vector<std::string> result;
  for (const JsonPlace& place : list()) result.push_back(place.text());
  return result;
}

}  // namespace mcdbn
