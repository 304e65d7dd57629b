#pragma once

#include <vector>

#include "device/row_tile.hpp"

namespace mcdbn::test {

/// Those whose work-groups the device takes.
inline std::vector<RowTile> fitting_tiles(const Device& device, std::vector<RowTile> tiles) {
  std::erase_if(tiles, [&](const RowTile& tile) {
    return limited({.group = tile.group}, device.info()).group < tile.group;
  });
  return tiles;
}

}  // namespace mcdbn::test
