#pragma once

#include <string>
#include <string_view>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

/// The matrix in the bytes of a .npy file. @throws std::runtime_error saying what is wrong with it
MatrixF npy_matrix(std::string_view bytes);
/// The bytes of a .npy file, version 1.
std::string npy_bytes(const MatrixF& values);

}  // namespace mcdbn
