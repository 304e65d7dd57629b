#pragma once

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

/// What is left of one frame's difference after the best similarity transform (Umeyama 1991).
/// @param truth, regenerated [1 x 3·joints]
RowVectorD procrustes_residual(const Eigen::Ref<const RowVectorD>& truth,
                               const Eigen::Ref<const RowVectorD>& regenerated);

/// The rotation about the origin that brings `source` nearest to `target`, over all their points
/// (Kabsch 1976). @param target, source [frames x 3·joints]
Eigen::Matrix3d nearest_rotation(const MatrixD& target, const MatrixD& source);

}  // namespace mcdbn
