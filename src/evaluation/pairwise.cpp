#include "evaluation/pairwise.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "base/interruption.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/evaluation/pearson.hpp"

namespace mcdbn {

std::vector<double> pairwise_pearson(const std::vector<MatrixD>& clips) {
  for (const MatrixD& clip : clips)
    if (clip.cols() != clips[0].cols() || clip.size() == 0)
      throw ShapeError(fmt::format("cannot pair clips of {}x{} and {}x{}", clips[0].rows(),
                                   clips[0].cols(), clip.rows(), clip.cols()));
  std::vector<double> correlations;
  correlations.reserve(clips.size() * (clips.size() + 1) / 2);
  for (std::size_t i = 0; i < clips.size(); ++i)
    for (std::size_t j = i + 1; j < clips.size(); ++j) {
      check_interruption();
      // Rows are contiguous, so the first frames are the first entries.
      const Eigen::Index entries = std::min(clips[i].size(), clips[j].size());
      correlations.push_back(pearson(Eigen::Map<const Eigen::VectorXd>(clips[i].data(), entries),
                                     Eigen::Map<const Eigen::VectorXd>(clips[j].data(), entries)));
    }
  return correlations;
}

}  // namespace mcdbn
