#include "base/utf8.hpp"

#include <cstddef>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

/// Bytes of the character that begins like this; 0: none does.
std::size_t length_of(unsigned char first) {
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first < 0xE0) return 2;
  if (first >= 0xE0 && first < 0xF0) return 3;
  return first >= 0xF0 && first < 0xF5 ? 4 : 0;
}

/// Not longer than it has to be, no half of a pair of UTF-16, not beyond U+10FFFF.
bool is_possible_second(unsigned char first, unsigned char second) {
  const unsigned char least = first == 0xE0 ? 0xA0 : first == 0xF0 ? 0x90 : 0x80;
  const unsigned char most = first == 0xED ? 0x9F : first == 0xF4 ? 0x8F : 0xBF;
  return second >= least && second <= most;
}

}  // namespace

bool is_utf8(std::string_view bytes) {
  const auto at = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  for (std::size_t i = 0; i < bytes.size();) {
    const std::size_t length = length_of(at(i));
    if (length == 0 || i + length > bytes.size()) return false;
    if (length > 1 && !is_possible_second(at(i), at(i + 1))) return false;
    for (std::size_t k = 2; k < length; ++k)
      if (at(i + k) < 0x80 || at(i + k) > 0xBF) return false;
    i += length;
  }
  return true;
}

void require_utf8(std::string_view bytes, const std::string& what) {
  if (!is_utf8(bytes))
    throw InputError(what + " is not UTF-8 text, which a model's file needs; rename it");
}

}  // namespace mcdbn
