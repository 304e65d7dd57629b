#pragma once

#include "mcdbn/machines/cdbn.hpp"

namespace mcdbn {

/// Fills the missing (NaN) entries of a sequence with the CDBN's own reconstruction: frame by
/// frame, the lowest layer's mean field between its hidden units and the missing visible ones,
/// given the frames before (the training mean where the sequence has not begun) and the values that
/// are seen. Frames without gaps stay as they are.
/// @param sequence [frames x visible of the lowest layer]
MatrixF complete_sequence(const Cdbn& cdbn, MatrixF sequence);

}  // namespace mcdbn
