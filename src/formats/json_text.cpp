#include "formats/json_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {

using nlohmann::json;

namespace {

std::string kind_of(const json& value) {
  if (value.is_null()) return "nothing (null)";
  if (value.is_boolean()) return "a truth value";
  if (value.is_string()) return "a text";
  if (value.is_array()) return "a list";
  if (value.is_object()) return "an object";
  return "a number";
}

/// The text with null for Python's NaN and Infinity outside of strings.
std::string without_nan(std::string_view text) {
  std::string result;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (quoted && text[i] == '\\' && i + 1 < text.size()) {
      result += text[i++];
    } else if (text[i] == '"') {
      quoted = !quoted;
    } else if (!quoted) {
      const std::array<std::string_view, 3> words{"NaN", "-Infinity", "Infinity"};
      const auto* word = std::ranges::find_if(
          words, [&](std::string_view w) { return text.substr(i).starts_with(w); });
      if (word != words.end()) {
        result += "null";
        i += word->size() - 1;
        continue;
      }
    }
    result += text[i];
  }
  return result;
}

/// @param lines_before of the file, for messages
json parse_value(std::string_view text, const std::string& file, long lines_before) {
  try {
    return json::parse(text);
  } catch (const json::parse_error& error) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
    const auto line = 1 + lines_before + std::count(text.begin(), end, '\n');
    throw InputError(fmt::format("{}:{}: no readable JSON from here on", file, line));
  } catch (const json::exception&) {
    throw InputError(fmt::format("{}: a number in it is too large to be read", file));
  }
}

bool is_blank(std::string_view text) {
  return text.find_first_not_of(" \t\r\n") == std::string_view::npos;
}

/// The first line is a list or an object by itself, and more than blanks follow.
bool are_json_lines(std::string_view text) {
  const auto end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  const auto first = line.find_first_not_of(" \t");
  if (first == std::string_view::npos || (line[first] != '{' && line[first] != '[')) return false;
  return !is_blank(text.substr(end)) && json::accept(line);
}

json parse_lines(std::string_view text, const std::string& file) {
  json values = json::array();
  for (long before = 0; !text.empty(); ++before) {
    const auto end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (!is_blank(line)) values.push_back(parse_value(line, file, before));
  }
  return values;
}

}  // namespace

void JsonPlace::fail(const std::string& what) const {
  throw InputError(path_.empty() ? fmt::format("{}: {}", file_, what)
                                 : fmt::format("{}: {}: {}", file_, path_, what));
}

JsonPlace JsonPlace::operator[](const std::string& key) const {
  if (!is_object()) fail(fmt::format("{} where an object is expected", kind_of(*value_)));
  const auto found = value_->find(key);
  if (found == value_->end()) fail(fmt::format("no key '{}'", key));
  return {*found, *this, path_.empty() ? key : "." + key};
}

JsonPlace JsonPlace::at(std::size_t index) const {
  if (!is_list()) fail(fmt::format("{} where a list is expected", kind_of(*value_)));
  if (index >= value_->size()) fail(fmt::format("{} values; more are needed", value_->size()));
  return {(*value_)[index], *this, fmt::format("[{}]", index)};
}

std::vector<JsonPlace> JsonPlace::list() const {
  if (!is_list()) fail(fmt::format("{} where a list is expected", kind_of(*value_)));
  std::vector<JsonPlace> places;
  for (std::size_t i = 0; i < value_->size(); ++i) places.push_back(at(i));
  return places;
}

std::vector<std::string> JsonPlace::keys() const {
  if (!is_object()) fail(fmt::format("{} where an object is expected", kind_of(*value_)));
  std::vector<std::string> names;
  for (const auto& [key, value] : value_->items()) names.push_back(key);
  return names;
}

double JsonPlace::number() const {
  if (value_->is_null()) return std::numeric_limits<double>::quiet_NaN();
  if (!value_->is_number()) fail(fmt::format("{} where a number is expected", kind_of(*value_)));
  return value_->get<double>();
}

long long JsonPlace::whole_number() const {
  const double value = value_->is_null() ? 0.5 : number();
  if (value != std::floor(value) || std::abs(value) > 1e15) fail("no usable whole number");
  return static_cast<long long>(value);
}

std::string JsonPlace::text() const {
  if (!value_->is_string()) fail(fmt::format("{} where a text is expected", kind_of(*value_)));
  return value_->get<std::string>();
}

std::vector<double> JsonPlace::numbers() const {
  if (!is_list()) fail(fmt::format("{} where a list of numbers is expected", kind_of(*value_)));
  std::vector<double> result;
  result.reserve(value_->size());
  for (std::size_t i = 0; i < value_->size(); ++i) {
    const json& value = (*value_)[i];
    result.push_back(value.is_number() ? value.get<double>() : at(i).number());
  }
  return result;
}

json parse_json(std::string_view text, const std::string& file) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  std::string readable;
  if (text.find("NaN") != std::string_view::npos || text.find("Infinity") != std::string_view::npos)
    text = readable = without_nan(text);
  return are_json_lines(text) ? parse_lines(text, file) : parse_value(text, file, 0);
}

}  // namespace mcdbn
