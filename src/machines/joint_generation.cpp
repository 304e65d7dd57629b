// A free sample of a whole MCDBN.

#include "mcdbn/base/errors.hpp"
#include "mcdbn/machines/generation.hpp"

namespace mcdbn {
namespace {

MatrixF one_after_another(const MatrixF& seed, const MatrixF& frames) {
  MatrixF both(seed.rows() + frames.rows(), frames.cols());
  both << seed, frames;
  return both;
}

}  // namespace

std::vector<std::vector<MatrixF>> generate(const Mcdbn& network, std::size_t leads,
                                           const std::vector<MatrixF>& seeds,
                                           const GenerationOptions& options,
                                           RegenerationOptions others) {
  if (leads >= network.modality_count()) throw ShapeError("generation: no such modality leads");
  std::vector<std::vector<MatrixF>> result(network.modality_count());
  const std::vector<MatrixF> frames = generate(network.cdbns[leads], seeds, options);
  for (std::size_t i = 0; i < frames.size(); ++i)
    result[leads].push_back(one_after_another(seeds[i / options.samples], frames[i]));
  others.samples = 1;
  for (std::size_t m = 0; m < result.size(); ++m)
    if (m != leads && !frames.empty()) result[m] = regenerate(network, result, m, others);
  // The seed gave the others their history.
  for (auto& modality : result)
    for (MatrixF& clip : modality)
      clip = MatrixF(clip.bottomRows(static_cast<Eigen::Index>(options.frames)));
  return result;
}

}  // namespace mcdbn
