#include "evaluation/sample_spread.hpp"

#include <limits>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {

double diversity_mm(const std::vector<MatrixD>& samples, int root_joint) {
  double sum = 0;
  int pairs = 0;
  for (std::size_t i = 0; i < samples.size(); ++i)
    for (std::size_t j = i + 1; j < samples.size(); ++j, ++pairs)
      sum += mean_joint_distance_mm(samples[i], samples[j], root_joint);
  return pairs ? sum / pairs : std::numeric_limits<double>::quiet_NaN();
}

BestSample best_of(const MatrixD& truth, const std::vector<MatrixD>& samples, double fps,
                   int root_joint) {
  if (samples.empty()) throw ShapeError("there is no sample to choose the best of");
  std::size_t best = 0;
  double best_mm = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double mm = mean_joint_distance_mm(truth, samples[i], root_joint);
    if (mm < best_mm) best_mm = mm, best = i;
  }
  return {best, joint_error(truth, samples[best], fps, root_joint)};
}

}  // namespace mcdbn
