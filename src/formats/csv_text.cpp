#include "formats/csv_text.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "base/shown.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r";
  const auto first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const auto end = text.find(separator);
    parts.push_back(trimmed(text.substr(0, end)));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

std::string_view without_quotes(std::string_view cell) {
  if (cell.size() < 2 || cell.front() != cell.back()) return cell;
  return cell.front() == '"' || cell.front() == '\'' ? trimmed(cell.substr(1, cell.size() - 2))
                                                     : cell;
}

std::optional<double> number(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || std::isinf(value)) return {};
  return value;
}

std::string time_cell(double time_s) {
  return fmt::format("{}", std::round(1e7 * time_s) / 1e7);
}

void require_csv_name(const std::string& name) {
  if (name.find_first_of(",;\t\n\r#\"") == std::string::npos && trimmed(name) == name) return;
  throw InputError(
      fmt::format("joint name {} cannot stand in a CSV header; rename the joint", shown(name)));
}

}  // namespace mcdbn
