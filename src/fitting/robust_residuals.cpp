#include "fitting/robust_residuals.hpp"

#include <cmath>
#include <utility>

#include "base/upper_median.hpp"

namespace mcdbn {

double robust_deviation(std::vector<double> residuals) {
  if (residuals.empty()) return 0;
  for (double& residual : residuals) residual = std::abs(residual);
  return 1.4826 * upper_median(std::move(residuals));
}

}  // namespace mcdbn
