#pragma once

#include <cmath>

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// Whether frame 0 is a calibration pose that was put before the motion: an authored pose,
/// that is whole degrees in every rotation channel and nearly all of them zero (a T-pose; the CMU
/// files have 7 of 93 that are not zero), from which frame 1 jumps away by more than motion can.
bool has_leading_calibration_pose(const Motion& motion);
/// The clip from its second frame on. @throws ShapeError if it has fewer than two frames
Motion without_first_frame(const Motion& motion);

/// How many frames a clip or a track has at another rate: those that fit into its duration from
/// `phase` new frames on, at least one. A rounded frame time may put the last a little past the
/// end: `slack` new frames are given.
/// @throws ConfigError if one is no frame rate, InputError for more than kMostFrames
int frames_at_rate(int frames, double rate_hz, double target_hz, double phase, double slack);
inline constexpr double kMostFrames = 1e7;

/// Relative difference up to which two rates are the same one: of files, which print their frame
/// time rounded, and of rates that are exact.
inline constexpr double kPrintedRate = 0.005, kSameRate = 1e-6;
inline bool is_same_rate(double one_hz, double other_hz) {
  return std::abs(one_hz / other_hz - 1) < kSameRate;
}

/// Resamples a clip to `target_hz`: low-pass below the new Nyquist rate first when going down
/// (zero phase, so nothing is delayed; flat to 0.3 of the new rate, −6 dB at 0.4, nothing from
/// 0.5 on), then interpolation. Rotations are filtered and interpolated
/// as rotations, not as angles, and come back as continuous angles in the file's own order.
/// @param phase shifts the sampling grid by `phase` target frames, 0 <= phase < 1: other phases of
///        the same clip are free augmentation.
/// @param same_rate kPrintedRate or kSameRate
/// @return the clip as it is where its rate is `target_hz` to `same_rate` and phase is 0. Else as
///         many frames as fit into its duration, at least one. Channels that never change keep
///         their exact value.
/// @throws ConfigError if target_hz or phase is out of range, ShapeError for a clip without frames
Motion resample(const Motion& motion, double target_hz, double phase = 0.0,
                double same_rate = kPrintedRate);

}  // namespace mcdbn
