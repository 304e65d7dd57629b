#pragma once

#include <Eigen/SparseCore>

namespace mcdbn {

/// What frames tell of the lengths of a body, whatever else is unknown in them: the Schur
/// complement of the rest in JᵀJ.
/// @param derivatives of the residuals, J, as WindowProblem has them: the lengths are the last
///        columns  @return [lengths x lengths], symmetric; 0 where the rest cannot be told
Eigen::MatrixXd information_on_lengths(const Eigen::SparseMatrix<double>& derivatives,
                                       Eigen::Index lengths);

}  // namespace mcdbn
