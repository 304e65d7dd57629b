#include "evaluation/sample_spread.hpp"

#include <limits>

namespace mcdbn {

double diversity_mm(const std::vector<MatrixD>& samples) {
  double sum = 0;
  int pairs = 0;
  for (std::size_t i = 0; i < samples.size(); ++i)
    for (std::size_t j = i + 1; j < samples.size(); ++j, ++pairs)
      sum += mean_joint_distance_mm(samples[i], samples[j]);
  return pairs ? sum / pairs : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace mcdbn
