#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "mcdbn/camera/track.hpp"

namespace mcdbn::test {

/// Of those frames only the joints of these names are seen.
inline void show_only(Track2d& track, int first, int frames,
                      const std::vector<std::string>& names) {
  for (int joint = 0; joint < track.joint_count(); ++joint)
    if (std::ranges::count(names, track.joint_names[static_cast<std::size_t>(joint)]) == 0) {
      track.confidence.col(joint).segment(first, frames).setZero();
      for (MatrixD* values : {&track.x_px, &track.y_px})
        values->col(joint).segment(first, frames).setConstant(std::nan(""));
    }
}

}  // namespace mcdbn::test
