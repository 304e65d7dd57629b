#pragma once

#include <array>
#include <string>
#include <vector>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn::test {

/// Figures of a report once more, in the plainest way, for comparison.

/// Mean, deviation (n − 1), median, and mode as the centre of the fullest of 20 bins.
struct HandStatistics {
  double mean = 0, deviation = 0, median = 0, minimum = 0, maximum = 0, mode = 0;
  std::vector<int> counts;
};
HandStatistics statistics_by_hand(std::vector<double> values);
std::vector<int> counts_by_hand(const std::vector<double>& values, double low, double high,
                                int bins);

/// Correlation of the first frames of two clips, as many as the shorter one has.
double correlation_by_hand(const MatrixD& a, const MatrixD& b);

/// Joints 1 … joints − 1 relative to joint 0. @param points [frames x 3·points]
MatrixD relative_by_hand(const MatrixD& points, int joints);
/// Mean distance of two clips' joints but the root, relative to it.
double distance_by_hand(const MatrixD& a, const MatrixD& b, int joints);

/// Sum of log densities. @param family as reports name it
double log_likelihood_by_hand(const std::string& family, const std::vector<double>& parameters,
                              const std::vector<double>& values);
/// Shape and scale of a Weibull by maximum likelihood: bisection of the shape's own equation.
std::array<double, 2> weibull_by_hand(const std::vector<double>& values);
/// Their standard errors: the inverse of the log-likelihood's second differences.
std::array<double, 2> weibull_errors_by_hand(const std::array<double, 2>& fit,
                                             const std::vector<double>& values);
/// The integral of f1 ln(f1 / f2) over x, by the midpoint rule.
double weibull_divergence_by_hand(const std::array<double, 2>& f1, const std::array<double, 2>& f2);

}  // namespace mcdbn::test
