#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "base/json_place.hpp"

namespace mcdbn {

/// Python's NaN and Infinity are read, too, as null. JSON lines, a value in each line, are a list
/// of them. @throws InputError `file:line: what`
nlohmann::json parse_json(std::string_view text, const std::string& file);

}  // namespace mcdbn
