#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mcdbn/device/matrix.hpp"

namespace mcdbn {

/// Clips one after another in one frame matrix on the device. Codes of higher layers keep the row
/// numbers of the frames they belong to; the first `valid_from` rows of each clip have no code.
struct Sequences {
  struct Clip {
    std::size_t first = 0;
    std::size_t frames = 0;
    double weight = 1;  ///< of each frame in the draw of mini-batches
  };
  Matrix values;  ///< [all frames x dimension]
  std::vector<Clip> clips;
  std::size_t valid_from = 0;
  Matrix seen{};  ///< like `values`: 1 what was seen, 0 what was not; empty: all was

  /// @param seen of each clip, in its shape, or none  @throws ShapeError if clips differ in columns
  static Sequences from_host(Device& device, std::span<const MatrixF> clips,
                             std::span<const MatrixF> seen = {});
  static Sequences from_host(Device& device, const std::vector<MatrixF>& clips) {
    return from_host(device, std::span<const MatrixF>(clips));
  }
  std::vector<MatrixF> to_host() const;

  /// Rows that have a code and `order` coded rows before them within their clip.
  std::vector<std::int32_t> window_rows(std::size_t order) const;
  /// Weight of each row in the draw of mini-batches, its clip's; empty where all clips weigh the
  /// same. @param rows in ascending order
  std::vector<double> weights(std::span<const std::int32_t> rows) const;
};

}  // namespace mcdbn
