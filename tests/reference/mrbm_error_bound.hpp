#pragma once

#include "reference/mrbm_reference.hpp"
#include "reference/running_error.hpp"

namespace mcdbn::reference {

struct BoundedMrbm {
  std::array<Bounded, 2> weights, visible_bias;
  Bounded hidden_bias;
};

/// The gradient of multi_prediction() with a bound on what single precision makes of it.
BoundedMrbm bounded_multi_prediction(const Mrbm& model, const std::array<MatrixD, 2>& batch,
                                     int steps);

}  // namespace mcdbn::reference
