#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

/// A .safetensors file: named float tensors and text metadata. Python's safetensors package reads
/// what we write as it is. Numbers are of 32 bits in memory.
struct Safetensors {
  struct Tensor {
    std::vector<std::size_t> shape;
    std::vector<float> values;  ///< row-major
  };
  std::map<std::string, Tensor> tensors;
  std::map<std::string, std::string> metadata;
  bool half = false;  ///< written as numbers of 16 bits (F16), rounded to the nearest

  void put(const std::string& name, const MatrixF& values);
  /// @throws InputError naming `file` if there is no such matrix of that shape
  MatrixF get(const std::string& name, const std::string& file, Eigen::Index rows,
              Eigen::Index columns) const;
};

/// Writes atomically, byte for byte the same for the same content. @throws InputError
void write_safetensors(const std::filesystem::path& path, const Safetensors& content);
/// @throws InputError if the file is missing, damaged or holds other types than F32 and F16
Safetensors read_safetensors(const std::filesystem::path& path);

}  // namespace mcdbn
