#pragma once

#include <Eigen/Core>

#include "mcdbn/camera/camera.hpp"
#include "mcdbn/camera/track.hpp"

namespace mcdbn {

/// Least cosine of the angle between a ray and the level view's direction: a ray 84 degrees or more
/// aside is not in the view.
inline constexpr double kLevelViewLeastCosine = 0.1;

/// level_from_world of a camera with the world's +y up: its pitch and roll are taken out, its
/// heading stays. The level axes are x right and horizontal, y straight down, z the horizontal part
/// of the viewing direction; of a camera that looks straight up or down, of the image's upper edge
/// or of the lower one.
Eigen::Matrix3d level_rotation(const Eigen::Matrix3d& camera_from_world);

/// The camera's level view: a pinhole where the camera stands, without its pitch, roll and lens.
/// The image has the camera's size, the viewing direction in its middle.
/// @param field_of_view_deg vertical, of the level view
/// @throws ConfigError if it is not in CameraPlacement's range
Camera level_camera(const Camera& camera, double field_of_view_deg);

/// The track of one camera as another one at the same place would have it: along the same rays. A
/// joint is missing where it is missing in the track or lies so far to the side of the other view
/// (within 6 degrees of its image plane, or behind it) that its pixels carry no information. Names,
/// confidence and rate stay; the image has the size of the other camera's.
Track2d turn_track(const Track2d& track, const Camera& from, const Camera& to);

}  // namespace mcdbn
