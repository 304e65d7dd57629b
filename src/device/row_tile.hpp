#pragma once

#include <optional>
#include <string>

#include "device/program.hpp"
#include "mcdbn/device/device.hpp"

namespace mcdbn {

/// How the fused kernels divide their work (kernels/tile.clh, contrastive_divergence_update.cl). No
/// choice changes a result, only the time it takes.
struct RowTile {
  int vector_width = 16;     ///< floats that a work-item takes at once: 1, 4, 8 or 16
  int rows = 10;             ///< that one work-group carries through a whole chain
  int columns = 1;           ///< vectors that a work-item accumulates side by side
  int group = 1;             ///< work-items that share a block of rows
  int update_rows = 8;       ///< rows of a gradient's tile: 4, 8 or 16
  int update_columns = 2;    ///< vectors of a row of that tile
  int most_panel_tiles = 6;  ///< such tiles that local memory holds
  bool operator==(const RowTile&) const = default;
};

/// What suits the device and the batch; nothing, with a message at debug level, where not even one
/// row, or one tile of a gradient, fits its local memory.
/// @param floats_per_row state of a row in local memory  @param what the kernel, for the message
std::optional<RowTile> choose_row_tile(const Device& device, std::size_t floats_per_row,
                                       std::size_t batch, const std::string& what);

/// A kernel's own definitions with those of tile.clh: ROWS, COLUMNS and GROUP.
Defines with_tile(Defines defines, const RowTile& tile);

/// with_tile() for a kernel that works on panels of gradients (kernels/weight_tile.clh).
Defines with_update_tile(Defines defines, const RowTile& tile);

/// Work-groups for the gradient of a weight matrix. @param rows of the matrix as the device pads it
std::size_t update_panels(const RowTile& tile, std::size_t rows);

/// Rows of a mini-batch that such a kernel takes at a time. Where there are more, sums that are not
/// complete wait in memory.
inline constexpr std::size_t kUpdateChunk = 128;

/// The batch, filled up to whole blocks of rows; unchanged without a tile.
std::size_t whole_blocks(std::size_t batch, const std::optional<RowTile>& tile);

}  // namespace mcdbn
