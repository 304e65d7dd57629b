#include "formats/csv_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include "base/interruption.hpp"
#include "base/shown.hpp"
#include "formats/csv_text.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

/// The separator that a header has most of.
char separator_of(std::string_view line) {
  char best = ',';
  for (const char separator : {';', '\t'})
    if (std::ranges::count(line, separator) > std::ranges::count(line, best)) best = separator;
  return best;
}

}  // namespace

CsvTable::CsvTable(std::string_view text, std::string file, std::size_t most)
    : file_(std::move(file)) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  char separator = '\0';
  for (int number = 1; !text.empty() && lines_.size() < most; ++number) {
    check_interruption();
    const auto end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (trimmed(line).empty() || trimmed(line).front() == '#') continue;
    if (separator == '\0') separator = separator_of(line);
    lines_.push_back({number, split(line, separator)});
    for (std::string_view& cell : lines_.back().cells) cell = without_quotes(cell);
  }
}

const CsvTable::Line& CsvTable::header() const {
  if (lines_.empty()) throw InputError(fmt::format("{}: empty", file_));
  return lines_.front();
}

double CsvTable::number_in(const Line& line, std::size_t column) const {
  const std::string_view cell = column < line.cells.size() ? line.cells[column] : "";
  if (cell.empty()) return std::numeric_limits<double>::quiet_NaN();
  const std::optional<double> value = number(cell);
  if (!value) fail(line, fmt::format("{} in column {} is not a number", shown(cell), column + 1));
  return *value;
}

double CsvTable::confidence_in(const Line& line, std::optional<std::size_t> column) const {
  const double value = column ? number_in(line, *column) : 1.0;
  return std::isnan(value) ? 1.0 : value;
}

void CsvTable::require_cells(const Line& line, std::size_t cells) const {
  if (line.cells.size() != cells)
    fail(line, fmt::format("{} cells where the header has {} columns", line.cells.size(), cells));
}

void CsvTable::fail(const Line& line, const std::string& what) const {
  throw InputError(fmt::format("{}:{}: {}", file_, line.number, what));
}

std::string lower(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(),
                         [](unsigned char letter) { return std::tolower(letter); });
  return result;
}

std::string plain(std::string_view name) {
  std::string result = lower(name);
  std::erase_if(result, [](char c) { return c == '_' || c == ' ' || c == '-' || c == '.'; });
  return result;
}

std::size_t index_of(std::vector<std::string>& names, std::string_view name) {
  const auto found = std::ranges::find(names, name);
  const auto index = static_cast<std::size_t>(found - names.begin());
  if (found == names.end()) names.emplace_back(name);
  return index;
}

}  // namespace mcdbn
