#pragma once

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

/// One frame of a track: a row of a Track2d.
struct TrackFrame {
  RowVectorD x_px, y_px, confidence;  ///< each [1 x joints]; not seen: NaN, confidence 0

  Eigen::Index joints() const { return x_px.size(); }
  /// A frame that shows none of its joints. @param joints their number
  static TrackFrame unseen(Eigen::Index joints);
};

}  // namespace mcdbn
