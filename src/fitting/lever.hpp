#pragma once

#include <Eigen/Core>

namespace mcdbn {

/// A part of a joint's way from the root that one orientation turns: camera axes.
struct Lever {
  int turn = 0;  ///< index of the orientation
  Eigen::Vector3d bone{0, 0, 0};
};

}  // namespace mcdbn
