#pragma once

#include <vector>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

/// @throws ShapeError unless every track has its pose of as many frames, columns agree over the
///         clips, and there is a frame to learn from
void check_clip_pairs(const std::vector<MatrixF>& tracks, const std::vector<MatrixF>& poses);

/// @throws ShapeError unless the baseline was fitted, to tracks of that many columns
void check_track(const MatrixF& track, Eigen::Index fitted_dimension);

/// All clips below one another.
MatrixF stacked(const std::vector<MatrixF>& clips);

}  // namespace mcdbn
