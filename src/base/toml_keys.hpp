#pragma once

#include <optional>
#include <string_view>

namespace mcdbn {

/// The line of a TOML text where a key has more parts (a.b.c) than any of ours. Tables are freed by
/// a function that calls itself for each part, so such a text must not be parsed.
std::optional<int> line_of_long_key(std::string_view text);

}  // namespace mcdbn
