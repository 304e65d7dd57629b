#pragma once

#include <vector>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

/// Flattened PCC of every pair of clips (Fig. 9, 10, 12). Where their lengths differ, the first
/// frames of the longer one are compared.
/// @param clips [frames x channels] each, channels equal
/// @return clips·(clips − 1)/2 values: (0,1), (0,2), …, (1,2), …; NaN where a clip never changes
/// @throws ShapeError if channels differ or a clip is empty
std::vector<double> pairwise_pearson(const std::vector<MatrixD>& clips);

}  // namespace mcdbn
