#pragma once

#include <vector>

namespace mcdbn {

/// Where Cauchy's weight 1 / (1 + (residual / (kCauchy · deviation))²) lets go: it keeps 95 % of
/// least squares' precision where the noise is normal.
inline constexpr double kCauchy = 2.385;

/// The middle value by size; of an even number of them the upper of the two in the middle.
/// @param values one at least
double upper_median(std::vector<double> values);

/// Standard deviation of the bulk of the residuals, whatever the signs: 1.4826 times their middle
/// size, as of the normal distribution. 0 for none.
double robust_deviation(std::vector<double> residuals);

}  // namespace mcdbn
