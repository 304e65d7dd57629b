#pragma once

#include "device/optimizer.hpp"
#include "reference/crbm_reference.hpp"
#include "reference/running_error.hpp"

namespace mcdbn::reference {

/// A CRBM's parameters, or their velocities, with error bounds.
struct BoundedCrbm {
  VisibleUnits visible_units = VisibleUnits::gaussian;
  Bounded W, A, B, a, b;

  /// Parameters that the device was given exactly.
  static BoundedCrbm exact(const Crbm& model);
  /// Velocities at the start of a training.
  static BoundedCrbm zeros_like(const Crbm& model);
};

struct BoundedCdStep {
  BoundedCrbm parameters;
  BoundedCrbm velocities;
  Bounded loss;                ///< mean squared error of the reconstruction [1 x 1]
  double uncertain_draws = 0;  ///< share of the draws that rounding may decide
};

/// One mini-batch of CD-k in single precision, contrastive_divergence() and update(), each number
/// with a bound on the device's error. What the mini-batch before left goes in with its errors.
BoundedCdStep bounded_cd_step(const BoundedCrbm& model, const BoundedCrbm& velocities,
                              const CrbmBatch& batch, int k, const HiddenDraws& draws,
                              const UpdateRule& rule_W, const UpdateRule& rule_A,
                              const UpdateRule& rule_B);

}  // namespace mcdbn::reference
