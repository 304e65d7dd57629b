#pragma once

#include "mcdbn/motion_model/clip_regeneration.hpp"

namespace mcdbn::test {

/// So many answers, each a little further off the single one.
inline PoseAnswers several(const PoseAnswer& single, std::size_t count) {
  return [single, count](const MatrixF& features) {
    std::vector<PosePrior> priors(count, single(features));
    for (std::size_t i = 0; i < count; ++i) priors[i].mean.array() += 0.3F * static_cast<float>(i);
    return priors;
  };
}

}  // namespace mcdbn::test
