#pragma once

#include <vector>

#include "mcdbn/evaluation/joint_error.hpp"

namespace mcdbn {

/// How much N variations of one clip differ: mean_joint_distance_mm over all pairs (average
/// pairwise distance). NaN below two samples.
/// @param samples [frames x 3·joints] in millimetres each  @throws ShapeError
double diversity_mm(const std::vector<MatrixD>& samples, int root_joint = 0);

/// The sample nearest to the truth by MPJPE, the first of equals.
struct BestSample {
  std::size_t index = 0;
  JointError error;
};

/// @throws ShapeError if there is no sample or one does not fit the truth
BestSample best_of(const MatrixD& truth, const std::vector<MatrixD>& samples, double fps,
                   int root_joint = 0);

}  // namespace mcdbn
