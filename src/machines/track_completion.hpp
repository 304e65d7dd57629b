#pragma once

#include "mcdbn/machines/cdbn.hpp"

namespace mcdbn {

/// Fills the missing (NaN) entries of a standardized 2D track with the CDBN's own reconstruction:
/// frame by frame, the lowest layer's mean field between its hidden units and the missing visible
/// ones, given the frames before and the joints that are seen. Frames without gaps stay as they
/// are.
/// @param track [frames x visible of the lowest layer]
MatrixF complete_track(const Cdbn& cdbn, MatrixF track);

}  // namespace mcdbn
