#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "base/json_place.hpp"

namespace mcdbn {

/// Whether a track's JSON shows nobody: null, an empty list or object, or lists and objects of
/// nothing else. In objects there may be numbers and texts beside them, but no x.
bool shows_nobody(const nlohmann::json& content);

/// Python's NaN and Infinity are read, too, as null. JSON lines, a value in each line, are a list
/// of them. @throws InputError `file:line: what`
/// @param are_lines gets whether they are JSON lines, if not null
nlohmann::json parse_json(std::string_view text, const std::string& file,
                          bool* are_lines = nullptr);

}  // namespace mcdbn
