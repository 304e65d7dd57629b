#include "motion_model/pose_priors.hpp"

namespace mcdbn {

std::vector<PosePrior> pose_priors(const Mcdbn& network, const std::vector<MatrixF>& tracks,
                                   const RegenerationOptions& options) {
  std::vector<PosePrior> priors;
  if (!network.deviation) {
    for (MatrixF& mean : regenerate(network, tracks, options)) priors.emplace_back(std::move(mean));
    return priors;
  }
  for (CodedAnswer& answer : coded_answers(network, tracks, options))
    priors.emplace_back(std::move(answer.mean), network.deviation->of(answer.code));
  return priors;
}

PosePrior pose_prior(const Mcdbn& network, const MatrixF& track) {
  return pose_priors(network, std::vector{track}).front();
}

}  // namespace mcdbn
