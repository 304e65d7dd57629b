#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

/// A matrix of a file, by its extension; one row is one frame or one case.
/// - .npy: NumPy's format, versions 1 to 3, of 2 dimensions or, as one column, of 1; floats of 32
///   or 64 bits, whole numbers and truth values, little endian, in C's or Fortran's order.
/// - .csv: numbers between commas. The first line may be a header, if there is no number in it. An
///   empty cell or `nan` is NaN; in a file of one column an empty line is one, but for the last.
/// - .safetensors: the tensor of that name, or the only one.
/// @param tensor name of a tensor of a .safetensors file; empty: its only one
/// @return at least one row and one column
/// @throws InputError `file:line: what` (without a line where the file has none)
MatrixF read_matrix(const std::filesystem::path& path, const std::string& tensor = "");

/// Writes atomically, by the extension: .npy as floats of 32 bits in C's order, .csv without a
/// header, every number with as many digits as it takes to read it back, .safetensors as `tensor`.
/// @throws InputError
void write_matrix(const std::filesystem::path& path, const MatrixF& values,
                  const std::string& tensor = "data");

/// Whether read_matrix and write_matrix know files of this name.
bool is_matrix_file(const std::filesystem::path& path);

/// The text of a .csv.
void write_csv(std::ostream& stream, const MatrixF& values);

}  // namespace mcdbn
