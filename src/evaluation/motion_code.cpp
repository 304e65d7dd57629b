#include "evaluation/motion_code.hpp"

#include <cmath>
#include <cstdint>

namespace mcdbn {
namespace {

std::string base64(const std::string& bytes) {
  static const char* const kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t block = 0;
    for (std::size_t k = 0; k < 3; ++k)
      block = block << 8 |
              (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : std::uint32_t{0});
    for (std::size_t k = 0; k < 4; ++k)
      text += k <= bytes.size() - i ? kDigits[block >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

/// Small numbers of either sign in one byte, seven bits a byte.
void append_integer(std::string& bytes, std::int64_t value) {
  auto rest = static_cast<std::uint64_t>(value < 0 ? -2 * value - 1 : 2 * value);
  while (rest >= 128) {
    bytes += static_cast<char>(128 | (rest & 127));
    rest >>= 7;
  }
  bytes += static_cast<char>(rest);
}

}  // namespace

std::string encode_series(const MatrixD& values) {
  std::string bytes;
  for (Eigen::Index column = 0; column < values.cols(); ++column) {
    std::int64_t before = 0, last = 0;
    for (Eigen::Index row = 0; row < values.rows(); ++row) {
      const double value = values(row, column);
      const std::int64_t rounded = std::isfinite(value) ? std::llround(value) : kMissing;
      append_integer(bytes, row == 0   ? rounded
                            : row == 1 ? rounded - last
                                       : rounded - (2 * last - before));
      before = last;
      last = rounded;
    }
  }
  return base64(bytes);
}

}  // namespace mcdbn
