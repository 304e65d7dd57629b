#include "fitting/robust_residuals.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mcdbn {

double upper_median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double robust_deviation(std::vector<double> residuals) {
  if (residuals.empty()) return 0;
  for (double& residual : residuals) residual = std::abs(residual);
  return 1.4826 * upper_median(std::move(residuals));
}

}  // namespace mcdbn
