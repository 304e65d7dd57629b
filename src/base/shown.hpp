#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace mcdbn {

/// The text with control characters but line ends escaped as \x1b, those that turn the direction of
/// writing too, and what is no UTF-8 replaced.
std::string printable(std::string_view text);

/// As printable(), in one line: line ends become spaces.
std::string printable_line(std::string text);

/// As printable(), of a longer text only the end.
std::string printable_end(const std::string& text, std::size_t longest);

/// A piece of input in quotes, for messages: not more than its beginning, and printable.
std::string shown(std::string_view text);

}  // namespace mcdbn
