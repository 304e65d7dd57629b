#pragma once

#include "camera/track_rays.hpp"
#include "mcdbn/camera/camera.hpp"

namespace mcdbn {

/// The root's position in the world, from the pose's positions of the joints around it and their
/// positions in the 2D track: least squares per frame over all joints (linear in the translation,
/// as rotation is known), depth and travel then fused with the model's own root velocity so that
/// depth noise does not become jitter.
/// @param relative_positions [frames x 3·joints] world axes, file units, relative to the root; of
///        the joints that `track` was made for
/// @param velocity [frames x 3] root velocity, world axes, file units per second (may have 0 rows)
/// @param velocity_error_m_s2 how much its changes are off, on a 1.7 m body
/// @return [frames x 3] world, file units
/// @throws ShapeError; InputError if no frame shows enough joints
MatrixD root_trajectory(const MatrixD& relative_positions, const TrackRays& track,
                        const Camera& camera, const MatrixD& velocity,
                        double velocity_error_m_s2 = 1.0);

/// The way from the first frame on at such velocities, each that of the step to its frame.
/// @param velocity [frames x 3] per second  @return [frames x 3]
MatrixD travelled_way(const MatrixD& velocity, double fps);

}  // namespace mcdbn
