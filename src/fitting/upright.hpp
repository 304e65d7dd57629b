#pragma once

#include "mcdbn/camera/camera.hpp"
#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// From the feet to the body's middle, the mean of all frames; without feet the camera's up.
/// @return the camera's axes, file units
Eigen::Vector3d upright_in_camera(const Motion& motion, const Camera& camera);

}  // namespace mcdbn
