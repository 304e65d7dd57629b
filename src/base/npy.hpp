#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

/// The numbers of an array of any dimensions, in C's order.
struct NpyArray {
  std::vector<std::size_t> shape;
  std::vector<double> values;
};

/// @throws std::runtime_error naming what is wrong with the bytes
NpyArray npy_array(std::string_view bytes);
/// The bytes of a .npy file, version 1, as floats of 64 bits.
std::string npy_bytes(const NpyArray& array);

/// The matrix in the bytes of a .npy file. @throws std::runtime_error naming what is wrong with it
MatrixF npy_matrix(std::string_view bytes);
/// The bytes of a .npy file, version 1.
std::string npy_bytes(const MatrixF& values);

}  // namespace mcdbn
