#pragma once

#include <vector>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

/// Frames before and after a frame that baselines see to answer for it. A clip's first and last
/// frames are repeated at its ends.
inline constexpr Eigen::Index kWindowReach = 5;
inline constexpr Eigen::Index kWindowFrames = 2 * kWindowReach + 1;

/// The windows of frames first … first + count − 1, earliest frame first.
/// @param track [frames x d2], no NaN  @return [count x kWindowFrames·d2]
MatrixF track_windows(const MatrixF& track, Eigen::Index first, Eigen::Index count);
/// The windows of all frames; 0, the training mean, where a joint was not seen.
MatrixF track_windows(const MatrixF& track);

/// All training frames.
struct WindowPairs {
  MatrixF windows;  ///< [frames x kWindowFrames·d2]
  MatrixF poses;    ///< [frames x d3]
};

/// @throws ShapeError as check_clip_pairs does
WindowPairs window_pairs(const std::vector<MatrixF>& tracks, const std::vector<MatrixF>& poses);

}  // namespace mcdbn
