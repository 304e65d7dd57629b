#pragma once

#include "mcdbn/camera/track.hpp"

namespace mcdbn {

/// The joints without those that a detector was unsure of and that lie elsewhere than an answer has
/// them: another limb, or something beside the person. Of an unsure joint that lies near the
/// answer's nothing better is known.
/// @param joints confidences are weights, 1 what is usual (weighted_by_confidence)
/// @param answer as the camera shows it, as many frames, among its joints those of `joints`; a
///        joint that it has not stays
/// @return those left out have confidence 0
Track2d agreeing_joints(Track2d joints, const Track2d& answer);

}  // namespace mcdbn
