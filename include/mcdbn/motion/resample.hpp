#pragma once

#include <string>

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// Whether frame 0 is a calibration pose: every rotation channel zero (T-pose), and frame 1 jumps
/// away from it by more than motion can (as in the CMU files).
bool has_leading_calibration_pose(const Motion& motion);
Motion without_first_frame(const Motion& motion);

/// Resamples a clip to `target_hz`: low-pass below the new Nyquist rate first when going down
/// (zero phase, so nothing is delayed), then interpolation. Rotations are filtered and interpolated
/// as rotations, not as angles, and come back as continuous angles in the file's own order.
/// @param phase shifts the sampling grid by `phase` target frames, 0 <= phase < 1: other phases of
///        the same clip are free augmentation.
Motion resample(const Motion& motion, double target_hz, double phase = 0.0);

}  // namespace mcdbn
