#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace mcdbn {

std::string_view trimmed(std::string_view text);

/// The parts between separators, each trimmed.
std::vector<std::string_view> split(std::string_view text, char separator);

/// What stands between the quotes, " or ', of a cell that has them.
std::string_view without_quotes(std::string_view cell);

/// The number that the whole of `text` is, if it is one; `nan` is one, infinity is not.
std::optional<double> number(std::string_view text);

/// A time as it stands in a cell: to 1e-7 s, also hours after the first, without zeros at its end.
std::string time_cell(double time_s);

/// @throws InputError if a joint of that name cannot stand in a CSV header
void require_csv_name(const std::string& name);

}  // namespace mcdbn
