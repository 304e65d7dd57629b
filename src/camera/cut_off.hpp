#pragma once

#include "mcdbn/camera/track.hpp"

namespace mcdbn {

/// A track without the joints that lie outside of its image. A detector that looks at one person's
/// part of the image puts them on the image's edge, with a low score: legs folded up into the edge
/// would be a crouching body. What is not sure and lies on the edge is unseen, but for a limb's end
/// whose joint before it is seen: the edge is near to where it is.
/// @param track with keypoints, else it stays as it is; confidences are weights, 1 what is usual
///        (weighted_by_confidence)
Track2d without_cut_off(Track2d track);

}  // namespace mcdbn
