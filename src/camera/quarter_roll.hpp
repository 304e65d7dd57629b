#pragma once

#include <optional>

#include "mcdbn/camera/track.hpp"

namespace mcdbn {

/// The roll of the camera (AssumedView::roll_deg) that sets a body upright which lies across the
/// image or is upside down in it, in quarter turns: 90, -90 or 180. None where that is so in no
/// more than half of the frames that show a direction. The directions are from hips to shoulders,
/// and from ankles, else knees, to shoulders, else hips; where a frame shows both they have to
/// agree, as they do not of somebody who bends forward or sits on the ground.
/// @param track with keypoints; without them there is none
std::optional<int> quarter_roll_deg(const Track2d& track);

}  // namespace mcdbn
