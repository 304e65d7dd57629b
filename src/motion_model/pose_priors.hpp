#pragma once

#include <vector>

#include "mcdbn/fitting/pose_prior.hpp"
#include "mcdbn/machines/regeneration.hpp"

namespace mcdbn {

/// A network's priors of the poses behind tracks: regenerate's answers, each with the network's own
/// deviation where it has learnt one (Mcdbn::deviation).
/// @param tracks standardized 2D [frames x dimension]
/// @return result[track · samples + sample]
std::vector<PosePrior> pose_priors(const Mcdbn& network, const std::vector<MatrixF>& tracks,
                                   const RegenerationOptions& options = {});
PosePrior pose_prior(const Mcdbn& network, const MatrixF& track);

}  // namespace mcdbn
