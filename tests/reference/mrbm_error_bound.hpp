#pragma once

#include "device/optimizer.hpp"
#include "reference/mrbm_reference.hpp"
#include "reference/running_error.hpp"

namespace mcdbn::reference {

/// An MRBM's parameters, their gradients or Adam's moments, with error bounds.
struct BoundedMrbm {
  std::array<Bounded, 2> weights, visible_bias;
  Bounded hidden_bias;

  /// Parameters that the device was given exactly.
  static BoundedMrbm exact(const Mrbm& model);
  /// Moments at the start of a training.
  static BoundedMrbm zeros_like(const BoundedMrbm& model);
};

struct BoundedMultiPrediction {
  BoundedMrbm gradient;
  std::array<Bounded, 2> losses;  ///< of modality m from the other: mean of a unit [1 x 1]
};

/// multi_prediction() with a bound on what single precision makes of it.
BoundedMultiPrediction bounded_multi_prediction(const BoundedMrbm& model,
                                                const std::array<MatrixD, 2>& batch, int steps);

/// Adam's update of every parameter, biases without decay.
void bounded_adam_update(BoundedMrbm& model, BoundedMrbm& mean, BoundedMrbm& square,
                         const BoundedMrbm& gradient, const UpdateRule& rule, int step);

}  // namespace mcdbn::reference
