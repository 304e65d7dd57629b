#pragma once

#include <vector>

#include "mcdbn/features/modalities.hpp"
#include "mcdbn/machines/mcdbn.hpp"

namespace mcdbn {

/// The rule by which samples of a network that was trained as a whole are drawn: in the MRBM's
/// chain, steadily, so strongly that at temperature 1 joints stray from the mean-field answer half
/// as far as that is from where they were in these clips. Where no draw takes them so far, the
/// scale is 2.
/// @param tracks, poses standardized, [frames x dimension] each  @throws ShapeError
SamplingRule calibrated_sampling(const Mcdbn& network, const Modalities& modalities,
                                 const std::vector<MatrixF>& tracks,
                                 const std::vector<MatrixF>& poses);

}  // namespace mcdbn
