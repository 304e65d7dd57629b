#pragma once

#include <vector>

#include "mcdbn/camera/track.hpp"

namespace mcdbn {

/// Keypoints of the columns: those that the file specifies, else the joints that the names denote.
std::vector<Keypoint> keypoints_of_columns(const Track2d& track);

/// Features, and in the place of those that are unknown (NaN) the others.
MatrixF where_known(const MatrixF& features, const MatrixF& otherwise);

}  // namespace mcdbn
