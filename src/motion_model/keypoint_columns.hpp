#pragma once

#include <vector>

#include "mcdbn/camera/track.hpp"

namespace mcdbn {

/// What the columns show: what their file says, else what their names tell of joints.
std::vector<Keypoint> keypoints_of_columns(const Track2d& track);

/// Features, and in the place of those that are unknown (NaN) the others.
MatrixF where_known(const MatrixF& features, const MatrixF& otherwise);

}  // namespace mcdbn
