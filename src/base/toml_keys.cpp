#include "base/toml_keys.hpp"

#include <algorithm>
#include <cstddef>

namespace mcdbn {
namespace {

/// Behind the string that begins there, of one line or of several (TOML 1.0, "String").
std::size_t end_of_string(std::string_view text, std::size_t begin) {
  const char quote = text[begin];
  const auto quotes_at = [&](std::size_t at) {
    const auto other = text.find_first_not_of(quote, at);
    return (other == std::string_view::npos ? text.size() : other) - at;
  };
  const bool is_long = quotes_at(begin) >= 3;
  for (std::size_t at = begin + (is_long ? 3 : 1); at < text.size(); ++at) {
    if (text[at] == '\\' && quote == '"')
      ++at;
    else if (!is_long && (text[at] == quote || text[at] == '\n'))
      return at + 1;
    else if (is_long && quotes_at(at) >= 3)
      return at + std::min<std::size_t>(quotes_at(at), 5);  // it may end in two of its own
  }
  return text.size();
}

}  // namespace

std::optional<int> line_of_long_key(std::string_view text) {
  constexpr int kMostDots = 16;
  int dots = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '"' || c == '\'')
      at = end_of_string(text, at) - 1;
    else if (c == '#')
      at = std::min(text.find('\n', at), text.size()) - 1;
    else if (std::string_view("\n=,[]{}").find(c) != std::string_view::npos)
      dots = 0;
    else if (c == '.' && ++dots > kMostDots)
      return 1 + static_cast<int>(std::ranges::count(text.substr(0, at), '\n'));
  }
  return {};
}

}  // namespace mcdbn
