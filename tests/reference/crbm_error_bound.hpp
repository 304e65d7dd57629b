#pragma once

#include "device/optimizer.hpp"
#include "reference/crbm_reference.hpp"
#include "reference/running_error.hpp"

namespace mcdbn::reference {

/// A CRBM's parameters with error bounds, in the order W, A, B, a, b.
struct BoundedCrbm {
  Bounded W, A, B, a, b;
};

struct BoundedCdStep {
  BoundedCrbm parameters;
  BoundedCrbm velocities;
  double uncertain_draws = 0;  ///< share of the draws that rounding may decide
};

/// One mini-batch of CD-k in single precision: contrastive_divergence() and update(), from
/// velocities of zero, each number with a bound on the device's error.
BoundedCdStep bounded_cd_step(const Crbm& model, const CrbmBatch& batch, int k,
                              const HiddenDraws& draws, const UpdateRule& rule_W,
                              const UpdateRule& rule_A, const UpdateRule& rule_B);

}  // namespace mcdbn::reference
