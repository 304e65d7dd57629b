#pragma once

#include <vector>

#include "mcdbn/camera/track.hpp"

namespace mcdbn {

/// Which frames show a body [frames]: at least half of the joints that the track shows at all. In a
/// detector's track only hips, knees, ankles, shoulders, elbows and wrists count, each joint once:
/// heel and toes of one foot, or one arm, are no body.
std::vector<bool> frames_of_a_body(const Track2d& track);

/// Which frames show an ankle or toes [frames].
/// @param track with keypoints
std::vector<bool> frames_of_feet(const Track2d& track);

/// Whether any frame does.
/// @param track with keypoints
bool shows_feet(const Track2d& track);

}  // namespace mcdbn
