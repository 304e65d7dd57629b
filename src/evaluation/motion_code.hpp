#pragma once

#include <string>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

/// Series of numbers as text for a page: each value rounded to a whole number, column by column
/// what is left after going on in a straight line (smooth motion leaves little), as variable-length
/// integers in base64. NaN becomes kMissing. report/motion.js is the decoder.
std::string encode_series(const MatrixD& values);

inline constexpr long kMissing = -100000;

}  // namespace mcdbn
