#pragma once

#include "mcdbn/base/matrices.hpp"

namespace mcdbn::reference {

/// Pearson's test of how often each state came against its probability. States that are expected
/// fewer than five times count as one.
/// @param counts, probabilities of all states; the probabilities sum to one
/// @return how often chance alone would give so large a misfit
double chi_square_p_value(const Eigen::VectorXd& counts, const Eigen::VectorXd& probabilities);

/// Rows of ones and zeros by the number of their state, as all_states() counts. @return [2^units]
Eigen::VectorXd state_counts(const MatrixD& rows);

}  // namespace mcdbn::reference
