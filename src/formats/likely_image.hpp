#pragma once

#include <optional>
#include <vector>

#include "formats/seen_people.hpp"

namespace mcdbn {

/// Images of which a track of shares may be, if nothing gives their size: a lying and an upright
/// one.
inline constexpr ImageSize kLyingImage{1920, 1080}, kUprightImage{1080, 1920};

/// Which of the two it is: that in which people are more like somebody who stands
/// (StandingLikeness). Only joints of head, arms, hips and legs are compared, one each: hands and
/// feet point anywhere. None: nobody shows three of them.
/// @param keypoints of the joints  @param frames people of each frame, as shares of the image
std::optional<ImageSize> likely_image(const std::vector<Keypoint>& keypoints,
                                      const std::vector<std::vector<SeenPerson>>& frames);

}  // namespace mcdbn
