#include "fitting/robust_residuals.hpp"

#include <algorithm>
#include <cmath>

namespace mcdbn {

double robust_deviation(std::vector<double> residuals) {
  if (residuals.empty()) return 0;
  for (double& residual : residuals) residual = std::abs(residual);
  const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
  std::nth_element(residuals.begin(), middle, residuals.end());
  return 1.4826 * *middle;
}

}  // namespace mcdbn
