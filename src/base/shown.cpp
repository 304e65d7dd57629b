#include "base/shown.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

namespace mcdbn {

namespace {

/// Bytes at the beginning of UTF-8 text that a terminal would obey instead of showing them: control
/// characters (ASCII's but line ends, and U+0080 to U+009F), and those that break lines or turn the
/// direction of writing (U+2028 to U+202E, U+2066 to U+2069).
std::size_t obeyed(std::string_view text) {
  const auto is_within = [&](std::size_t at, unsigned char first, unsigned char last) {
    const auto byte = static_cast<unsigned char>(at < text.size() ? text[at] : '\0');
    return first <= byte && byte <= last;
  };
  if (text.front() == '\n') return 0;
  if (is_within(0, 0x00, 0x1F) || is_within(0, 0x7F, 0x7F)) return 1;
  if (text.starts_with("\xC2") && is_within(1, 0x80, 0x9F)) return 2;
  if (text.starts_with("\xE2\x80") && is_within(2, 0xA8, 0xAE)) return 3;
  if (text.starts_with("\xE2\x81") && is_within(2, 0xA6, 0xA9)) return 3;
  return 0;
}

void append_escaped(std::string& result, std::string_view bytes) {
  for (const char byte : bytes)
    fmt::format_to(std::back_inserter(result), "\\x{:02x}", static_cast<unsigned char>(byte));
}

}  // namespace

std::string printable(std::string_view text) {
  using nlohmann::json;
  // There and back again, JSON replaces what is no UTF-8.
  const std::string valid =
      json::parse(json(std::string(text)).dump(-1, ' ', false, json::error_handler_t::replace));
  std::string result;
  for (std::string_view rest = valid; !rest.empty();) {
    const std::size_t length = obeyed(rest);
    if (length > 0)
      append_escaped(result, rest.substr(0, length));
    else
      result += rest.front();
    rest.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return result;
}

std::string printable_line(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  return printable(text);
}

std::string printable_end(const std::string& text, std::size_t longest) {
  if (text.size() <= longest) return printable_line(text);
  return "..." + printable_line(text.substr(text.size() - longest));
}

std::string shown(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  return fmt::format("'{}{}'", printable_line(std::string(text.substr(0, kLongest))),
                     text.size() > kLongest ? "..." : "");
}

}  // namespace mcdbn
