#pragma once

#include <optional>
#include <string>

#include "device/program.hpp"
#include "mcdbn/device/device.hpp"

namespace mcdbn {

/// How the fused kernels divide their work (kernels/tile.clh, contrastive_divergence_update.cl). No
/// choice changes a result, only the time it takes.
struct RowTile {
  int vector_width = 16;  ///< floats that a work-item takes at once: 1, 4, 8 or 16
  int rows = 10;          ///< that one work-group carries through a whole chain
  int columns = 1;        ///< vectors that a work-item accumulates side by side
  int group = 1;          ///< work-items that share a block of rows
  int update_rows = 16;   ///< rows of a gradient's tile: 4, 8 or 16
  bool operator==(const RowTile&) const = default;
};

/// What suits the device and the batch; nothing, with a message at debug level, where not even one
/// row fits the device's local memory.
/// @param floats_per_row state of a row in local memory  @param what the kernel, for the message
std::optional<RowTile> choose_row_tile(const Device& device, std::size_t floats_per_row,
                                       std::size_t batch, const std::string& what);

/// A kernel's own definitions with those of tile.clh: ROWS, COLUMNS and GROUP.
Defines with_tile(Defines defines, const RowTile& tile);

/// The batch, filled up to whole blocks of rows; unchanged without a tile.
std::size_t whole_blocks(std::size_t batch, const std::optional<RowTile>& tile);

}  // namespace mcdbn
