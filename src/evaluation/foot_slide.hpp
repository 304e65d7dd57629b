#pragma once

#include <vector>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

/// How fast planted feet move over the ground: where they are planted in the truth
/// (kPlantedInCapture), both clips are measured. NaN where no foot is ever planted.
struct FootSlide {
  double truth_mm_s = 0;        ///< mean horizontal speed; capture has some slide of its own
  double regenerated_mm_s = 0;  ///< the same of the regenerated clip
  int planted = 0;              ///< joint-frames that the means are over
};

/// @param truth, regenerated [frames x 3·joints] in the world, mm on a 1.7 m body, +y up
/// @param feet indices of foot joints  @param fps frames a second (Hz)
/// @throws ShapeError
FootSlide foot_slide(const MatrixD& truth, const MatrixD& regenerated, const std::vector<int>& feet,
                     double fps);

}  // namespace mcdbn
