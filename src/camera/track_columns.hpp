#pragma once

#include <utility>

#include "mcdbn/camera/track.hpp"

namespace mcdbn {

/// Where a frame shows a column's joint; NaN where it is missing.
inline Eigen::Vector2d pixel_at(const Track2d& track, Eigen::Index frame, Eigen::Index column) {
  return {track.x_px(frame, column), track.y_px(frame, column)};
}

/// Exchanges the values of two columns in one frame.
inline void exchange_columns(Track2d& track, Eigen::Index frame, Eigen::Index one,
                             Eigen::Index other) {
  for (MatrixD* values : {&track.x_px, &track.y_px, &track.confidence})
    std::swap((*values)(frame, one), (*values)(frame, other));
}

}  // namespace mcdbn
