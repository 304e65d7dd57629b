#pragma once

#include "camera/track_rays.hpp"
#include "mcdbn/camera/camera.hpp"

namespace mcdbn {

struct RootPath {
  MatrixD root;  ///< [frames x 3] world, file units
  /// Whether the pose does not match the rays, so that sizes of body and image gave the depth.
  bool by_size = false;
};

/// The root's position in the world, from the pose's positions of the joints around it and their
/// positions in the 2D track: least squares per frame over all joints (linear in the translation,
/// as rotation is known), depth and travel then fused with the model's own root velocity so that
/// depth noise does not become jitter. Where in most frames that show enough joints the pose does
/// not match the rays, as of a person upside down whom the pose has upright, or through a camera
/// that was rolled otherwise, least squares would put the body behind the camera: its depth then
/// follows from how large body and image are, whichever way either is turned.
/// @param relative_positions [frames x 3·joints] world axes, file units, relative to the root; of
///        the joints that `track` was made for
/// @param velocity [frames x 3] root velocity, world axes, file units per second (may have 0 rows)
/// @param velocity_error_m_s2 how much its changes are off, on a 1.7 m body
/// @throws ShapeError; InputError if no frame shows enough joints, or all of them at one place
RootPath root_trajectory(const MatrixD& relative_positions, const TrackRays& track,
                         const Camera& camera, const MatrixD& velocity,
                         double velocity_error_m_s2 = 1.0);

/// The way from the first frame on at such velocities, each that of the step to its frame.
/// @param velocity [frames x 3] per second  @return [frames x 3]
MatrixD travelled_way(const MatrixD& velocity, double fps);

}  // namespace mcdbn
