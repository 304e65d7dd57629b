#pragma once

#include "mcdbn/camera/camera.hpp"
#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// How a body stands: the mean of some frames.
struct Stance {
  Eigen::Vector3d upright{0, 0, 0};  ///< from the feet to the body's middle; the camera's axes
  double bent_legs = 0;  ///< 1 less the distance from hip to ankle as a share of a straight leg's
};

/// @return of all frames, in file units; without feet the camera's up and straight legs
Stance stance_in_camera(const Motion& motion, const Camera& camera);

/// The mean of two means, of so many frames; all zero without frames.
Stance mean_stance(const Stance& one, double frames_of_one, const Stance& other,
                   double frames_of_other);

}  // namespace mcdbn
