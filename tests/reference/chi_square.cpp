#include "reference/chi_square.hpp"

#include <boost/math/distributions/chi_squared.hpp>

namespace mcdbn::reference {

double chi_square_p_value(const Eigen::VectorXd& counts, const Eigen::VectorXd& probabilities) {
  const double total = counts.sum();
  double statistic = 0, rare_count = 0, rare_expected = 0;
  int cells = 0;
  const auto add = [&](double count, double expected) {
    statistic += (count - expected) * (count - expected) / expected;
    ++cells;
  };
  for (Eigen::Index s = 0; s < counts.size(); ++s) {
    const double expected = total * probabilities(s);
    if (expected >= 5.0) {
      add(counts(s), expected);
    } else {
      rare_count += counts(s);
      rare_expected += expected;
    }
  }
  if (rare_expected > 0.0) add(rare_count, rare_expected);
  const boost::math::chi_squared distribution(cells - 1);
  return boost::math::cdf(boost::math::complement(distribution, statistic));
}

Eigen::VectorXd state_counts(const MatrixD& rows) {
  Eigen::VectorXd counts = Eigen::VectorXd::Zero(Eigen::Index{1} << rows.cols());
  for (Eigen::Index r = 0; r < rows.rows(); ++r) {
    Eigen::Index state = 0;
    for (Eigen::Index j = 0; j < rows.cols(); ++j)
      state |= static_cast<Eigen::Index>(rows(r, j)) << j;
    counts(state) += 1.0;
  }
  return counts;
}

}  // namespace mcdbn::reference
