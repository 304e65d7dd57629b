#pragma once

#include <optional>

#include "mcdbn/model/crbm.hpp"

namespace mcdbn {

/// How the fused CD-k kernels divide their work (kernels/row_tile.clh, cd_update.cl). No choice
/// changes a result, only the time it takes.
struct ChainTile {
  int vector_width = 16;  ///< floats that a work-item takes at once: 1, 4, 8 or 16
  int rows = 10;          ///< of the mini-batch that one work-group carries through the chain
  int columns = 1;        ///< vectors that a work-item accumulates side by side
  int group = 1;          ///< work-items that share a block of rows
  int update_rows = 16;   ///< rows of a gradient's tile: 4, 8 or 16
  bool operator==(const ChainTile&) const = default;
};

/// Local memory that a block of rows needs: its visible means and its hidden units.
std::size_t chain_local_bytes(const CrbmShape& shape, const ChainTile& tile);

/// What suits the device and the batch; nothing, with a message at debug level, where not even one
/// row fits the device's local memory.
std::optional<ChainTile> choose_chain_tile(const Device& device, const CrbmShape& shape,
                                           std::size_t batch);

/// The batch, filled up to whole blocks of rows; unchanged without a tile.
std::size_t whole_blocks(std::size_t batch, const std::optional<ChainTile>& tile);

}  // namespace mcdbn
