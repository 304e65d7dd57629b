#pragma once

#include "device/pointwise.hpp"
#include "mcdbn/machines/crbm.hpp"

namespace mcdbn {

/// Frames as the machine's own units see them: over its visible_deviation, if it has one.
inline Matrix in_own_units(const Crbm& crbm, const Matrix& frames) {
  if (!crbm.has_deviation) return frames;
  Matrix scaled = Matrix::like(frames);
  scaled.copy_from(frames);
  scale_columns(scaled, crbm.visible_deviation, true);
  return scaled;
}

/// Converts the machine's own units to those of its data, in place.
inline void to_data_units(const Crbm& crbm, const Matrix& units) {
  if (crbm.has_deviation) scale_columns(units, crbm.visible_deviation);
}

}  // namespace mcdbn
