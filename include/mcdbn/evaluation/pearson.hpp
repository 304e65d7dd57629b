#pragma once

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

/// Pearson correlation of two equally long vectors (eq 47, 48); NaN where either never changes
/// (its range is below 1e-9 of its largest magnitude, which is rounding) or holds a NaN.
/// @throws ShapeError if they are empty or differ in length
double pearson(const Eigen::Ref<const Eigen::VectorXd>& x,
               const Eigen::Ref<const Eigen::VectorXd>& y);

/// The paper's figure: every entry of both clips in one vector.
/// @param truth, regenerated [frames x channels]  @throws ShapeError
double pearson_flat(const MatrixD& truth, const MatrixD& regenerated);

/// The strict figure: mean over columns of the column's own correlation. Columns in which the truth
/// never changes do not count; a column that the regeneration leaves constant counts as 0. What
/// stays below 1e-9 of the clip's largest magnitude does not count as change. NaN if no column
/// counts or either clip holds a NaN.
/// @param truth, regenerated [frames x channels]  @throws ShapeError
double pearson_per_channel(const MatrixD& truth, const MatrixD& regenerated);

}  // namespace mcdbn
