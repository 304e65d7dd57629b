#pragma once

#include "mcdbn/features/modalities.hpp"
#include "mcdbn/fitting/known_of_clip.hpp"

namespace mcdbn {

/// A person as detectors show one: keypoints are not the joints of a skeleton by proportions of
/// stature, and the bones between them are up to a third shorter or longer.
/// @param humanoid is_humanoid  @return with its bones so, as tall as before
Skeleton usual_body(Skeleton humanoid);

/// The skeleton that is given; else the model's, of usual proportions where a detector shows the
/// humanoid. What the fit's lengths are ratios to.
Skeleton body_to_begin_with(const KnownOfClip& known, const Modalities& modalities);

}  // namespace mcdbn
