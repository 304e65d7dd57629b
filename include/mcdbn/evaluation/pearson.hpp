#pragma once

#include "mcdbn/matrix_types.hpp"

namespace mcdbn {

/// Pearson correlation of two equally long vectors (eq 47, 48); NaN where either never changes.
double pearson(const Eigen::Ref<const Eigen::VectorXd>& x, const Eigen::Ref<const Eigen::VectorXd>& y);

/// The paper's figure: every entry of both clips in one vector.
double pearson_flat(const MatrixD& truth, const MatrixD& regenerated);

/// The strict figure: mean over columns of the column's own correlation. Columns in which the truth
/// never changes do not count; a column that the regeneration leaves constant counts as 0.
double pearson_per_channel(const MatrixD& truth, const MatrixD& regenerated);

}  // namespace mcdbn
