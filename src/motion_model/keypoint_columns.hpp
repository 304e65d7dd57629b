#pragma once

#include <vector>

#include "mcdbn/camera/track.hpp"

namespace mcdbn {

/// What the columns show: as their file specifies, else the joints that their names denote.
std::vector<Keypoint> keypoints_of_columns(const Track2d& track);

/// Features, and in the place of those that are unknown (NaN) the others.
MatrixF where_known(const MatrixF& features, const MatrixF& otherwise);

}  // namespace mcdbn
