#include "base/shown.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace mcdbn {

std::string printable(std::string_view text) {
  using nlohmann::json;
  // There and back again, JSON replaces what is no UTF-8.
  const std::string valid =
      json::parse(json(std::string(text)).dump(-1, ' ', false, json::error_handler_t::replace));
  std::string result;
  for (const char c : valid) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_control = (byte < 0x20 && c != '\n') || byte == 0x7F;
    if (!is_control) {
      result += c;
      continue;
    }
    constexpr std::string_view kDigits = "0123456789abcdef";
    result += "\\x";
    result += kDigits[byte / 16];
    result += kDigits[byte % 16];
  }
  return result;
}

std::string shown(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string beginning(text.substr(0, kLongest));
  std::ranges::replace(beginning, '\n', ' ');
  return fmt::format("'{}{}'", printable(beginning), text.size() > kLongest ? "..." : "");
}

}  // namespace mcdbn
