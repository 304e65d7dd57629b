#pragma once

#include <Eigen/Core>

namespace mcdbn {

/// The bones between the root and a joint that one orientation turns, as one vector.
struct Lever {
  int turn = 0;                   ///< index of the orientation
  Eigen::Vector3d bone{0, 0, 0};  ///< camera axes
};

}  // namespace mcdbn
