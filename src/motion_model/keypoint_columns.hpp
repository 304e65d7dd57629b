#pragma once

#include <vector>

#include "mcdbn/camera/track.hpp"

namespace mcdbn {

/// What the columns show: what their file says, else what their names tell of joints.
std::vector<Keypoint> keypoints_of_columns(const Track2d& track);

}  // namespace mcdbn
