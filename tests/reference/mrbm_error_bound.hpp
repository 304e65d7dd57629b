#pragma once

#include "device/optimizer.hpp"
#include "reference/mrbm_reference.hpp"
#include "reference/running_error.hpp"

namespace mcdbn::reference {

/// An MRBM's parameters, their gradients or Adam's moments, with error bounds.
struct BoundedMrbm {
  std::vector<Bounded> weights, visible_bias;
  Bounded hidden_bias;
  std::vector<bool> gaussian = {};  ///< as Mrbm::gaussian

  /// Parameters that the device was given exactly.
  static BoundedMrbm exact(const Mrbm& model);
  /// Moments at the start of a training.
  static BoundedMrbm zeros_like(const BoundedMrbm& model);
};

struct BoundedMultiPrediction {
  BoundedMrbm gradient;
  std::vector<Bounded> losses;  ///< of modality m from the others: mean of a unit [1 x 1]
};

/// multi_prediction() with a bound on what single precision makes of it.
BoundedMultiPrediction bounded_multi_prediction(const BoundedMrbm& model,
                                                const std::vector<MatrixD>& batch, int steps);

/// One step of every parameter down its gradient, biases without decay.
void bounded_momentum_update(BoundedMrbm& model, BoundedMrbm& velocity, const BoundedMrbm& gradient,
                             const UpdateRule& rule);
void bounded_adam_update(BoundedMrbm& model, BoundedMrbm& mean, BoundedMrbm& square,
                         const BoundedMrbm& gradient, const UpdateRule& rule, int step);

}  // namespace mcdbn::reference
