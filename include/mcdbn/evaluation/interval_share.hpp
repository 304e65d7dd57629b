#pragma once

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

/// How many standard deviations a 90 % interval of a normal distribution reaches to either side.
inline constexpr double kReachOf90 = 1.6448536269514722;

/// Share of 90 % intervals, answer ± kReachOf90 · deviation, that hold the truth: near 0.9 where
/// the deviations are calibrated. Deviations come from draws of the fit or from a network by
/// itself.
/// @param truth, answer, deviation of one shape and unit, a number for each frame and axis
/// @return NaN without numbers  @throws ShapeError
double share_within_90(const MatrixD& truth, const MatrixD& answer, const MatrixD& deviation);

}  // namespace mcdbn
