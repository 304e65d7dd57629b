#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace mcdbn {

/// The text with control characters but line ends escaped as \x1b, those that turn the direction of
/// writing too, and what is no UTF-8 replaced.
std::string printable(std::string_view text);

/// The same in one line: line ends are spaces.
std::string printable_line(std::string text);

/// The same, of a text that is longer its end.
std::string printable_end(const std::string& text, std::size_t longest);

/// A piece of input in quotes, for messages: not more than its beginning, and printable.
std::string shown(std::string_view text);

}  // namespace mcdbn
