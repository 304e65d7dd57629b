#include "formats/json_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/interruption.hpp"
#include "base/parsed_json.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {

using nlohmann::json;

namespace {

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
  if (nests_deeper(text, kDeepestJson))
    throw InputError(fmt::format("{}: nested deeper than any track", file));
  check_interruption();
  constexpr std::size_t kLong = 1 << 20;  // bytes
  std::size_t parts = 0;
  const auto look_now_and_then = [&](int, json::parse_event_t, json&) {
    constexpr std::size_t kEvery = 4096;
    if (++parts % kEvery == 0) check_interruption();
    return true;
  };
  try {
    return text.size() < kLong ? json::parse(text) : json::parse(text, look_now_and_then);
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

bool shows_nobody(const json& content) {
  if (content.is_array()) return std::ranges::all_of(content, shows_nobody);
  if (!content.is_object()) return content.is_null();
  if (content.contains("x")) return false;  // a landmark, whatever is null of it
  bool any = content.empty();
  for (const json& value : content) {
    if (!value.is_structured() && !value.is_null()) continue;
    if (!shows_nobody(value)) return false;
    any = true;
  }
  return any;
}

json parse_json(std::string_view text, const std::string& file, bool* are_lines) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  std::string readable;
  if (text.find("NaN") != std::string_view::npos || text.find("Infinity") != std::string_view::npos)
    text = readable = without_nan(text);
  const bool lines = are_json_lines(text);
  if (are_lines != nullptr) *are_lines = lines;
  return lines ? parse_lines(text, file) : parse_value(text, file, 0);
}

}  // namespace mcdbn
