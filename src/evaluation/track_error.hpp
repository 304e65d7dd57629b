#pragma once

#include <string>

#include "mcdbn/camera/track.hpp"

namespace mcdbn {

/// How far a 2D track regenerated from 3D is from the true projection, and how far one that always
/// shows the training mean would be.
struct TrackError {
  double track_error_px = 0;
  double mean_track_error_px = 0;
};

/// Mean distance of joints, each relative to its own track's root, in pixels of the image; over
/// frames and the joints of `regenerated` but the root, where both have them.
/// @param truth with the same joint names, frames and image  @return NaN where there are none
/// @throws ShapeError if frames differ, InputError if the truth lacks a joint
double track_error_px(const Track2d& truth, const Track2d& regenerated,
                      const std::string& root_name);

}  // namespace mcdbn
