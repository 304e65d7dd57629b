#pragma once

#include <vector>

#include "mcdbn/evaluation/joint_error.hpp"

namespace mcdbn {

/// How much N variations of one clip differ: mean_joint_distance_mm over all pairs (average
/// pairwise distance). NaN below two samples.
/// @param samples [frames x 3·joints] in millimetres each, the root first  @throws ShapeError
double diversity_mm(const std::vector<MatrixD>& samples);

}  // namespace mcdbn
