#pragma once

#include <vector>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn::reference {

/// A multimodal RBM (eq 19): modality m has D_m units, and all share K hidden units. Gradients use
/// this type too.
struct Mrbm {
  std::vector<MatrixD> weights;          ///< w^m [D_m x K]
  std::vector<RowVectorD> visible_bias;  ///< a^m [D_m]
  RowVectorD hidden_bias;                ///< b [K]
  std::vector<bool> gaussian = {};       ///< of each modality, whether its units are; none: binary

  bool is_gaussian(std::size_t m) const { return m < gaussian.size() && gaussian[m]; }

  /// All parameters behind one another, for finite differences.
  Eigen::VectorXd flattened() const;
  /// An MRBM of this one's shapes with those parameters.
  Mrbm with_parameters(const Eigen::VectorXd& flat) const;
};

/// What every pass computed, kept for the way back.
struct MeanFieldTrace {
  std::vector<MatrixD> hidden;   ///< ĥ after pass 1 … steps [batch x K] (eq 32)
  std::vector<MatrixD> missing;  ///< v̂ before pass 1 (zeros), then after each pass (eq 33)
  MatrixD missing_input;         ///< what the last pass's units of eq 33 took
};

/// Mean-field inference of the modality `missing` from all others, eq 32 and 33.
/// @param batch of each modality [batch x D_m]; that of the missing one is not read
/// @param steps passes of eq 32 and 33
MeanFieldTrace mean_field(const Mrbm& model, std::size_t missing, const std::vector<MatrixD>& batch,
                          int steps);
/// −log p(target | what its units took) but for a constant, summed over all: cross-entropy, or half
/// the squared error of Gaussian units.
double prediction_loss(const Mrbm& model, std::size_t missing, const MatrixD& target,
                       const MatrixD& input);

/// A loss and its gradient (downhill is minus it), both means over the batch.
struct MultiPrediction {
  double loss = 0;
  Mrbm gradient;
};

/// Multi-prediction training of eq 42: the loss of each modality predicted from the others, summed
/// over all directions and units, back-propagated through the unrolled mean field.
MultiPrediction multi_prediction(const Mrbm& model, const std::vector<MatrixD>& batch, int steps);

}  // namespace mcdbn::reference
