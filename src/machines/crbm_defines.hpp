#pragma once

#include "device/kernel_arguments.hpp"
#include "device/row_tile.hpp"
#include "mcdbn/machines/crbm.hpp"

namespace mcdbn {

/// Definitions for crbm_shape.clh.
inline Defines crbm_defines(const CrbmShape& shape, const RowTile& tile) {
  return {{"VEC", tile.vector_width},
          {"VISIBLE", to_int(shape.visible)},
          {"HIDDEN", to_int(shape.hidden)},
          {"ORDER_A", to_int(shape.order_A())},
          {"ORDER_B", to_int(shape.order_B())}};
}

/// crbm_defines() for a kernel whose visible units may be Gaussian, tiled by rows.
inline Defines crbm_row_defines(const CrbmShape& shape, const RowTile& tile) {
  Defines defines = crbm_defines(shape, tile);
  defines["GAUSSIAN"] = shape.kind == VisibleKind::gaussian ? 1 : 0;
  return with_tile(std::move(defines), tile);
}

}  // namespace mcdbn
