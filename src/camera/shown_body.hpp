#pragma once

#include <vector>

#include "mcdbn/camera/track.hpp"

namespace mcdbn {

/// Which frames show a body [frames]: half at least of the joints that the track shows at all. Of a
/// detector's places those of hips, knees, ankles, shoulders, elbows and wrists count, each joint
/// once: heel and toes of one foot, or one arm, are no body.
std::vector<bool> frames_of_a_body(const Track2d& track);

/// Whether an ankle or toes are seen in any frame.
/// @param track with keypoints
bool shows_feet(const Track2d& track);

}  // namespace mcdbn
