#pragma once

#include <array>
#include <vector>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn::reference {

/// A multimodal RBM (eq 19): modality m has D_m units, and both share K hidden units. Gradients use
/// this type too.
struct Mrbm {
  std::array<MatrixD, 2> weights;          ///< w^m [D_m x K]
  std::array<RowVectorD, 2> visible_bias;  ///< a^m [D_m]
  RowVectorD hidden_bias;                  ///< b [K]

  /// All parameters behind one another, for finite differences.
  Eigen::VectorXd flattened() const;
  /// An MRBM of this one's shapes with those parameters.
  Mrbm with_parameters(const Eigen::VectorXd& flat) const;
};

struct MeanFieldOptions {
  int steps = 5;                   ///< passes of eq 32 and 33
  bool double_first_pass = false;  ///< twice the present modality while the other is still zero
};

/// What every pass computed, kept for the way back.
struct MeanFieldTrace {
  std::vector<MatrixD> hidden;   ///< ĥ after pass 1 … steps [batch x K] (eq 32)
  std::vector<MatrixD> missing;  ///< v̂ before pass 1 (zeros), then after each pass (eq 33)
  MatrixD missing_input;         ///< what the last pass's sigmoid of eq 33 took
};

/// Mean-field inference of the other modality from modality `present` (0 or 1), eq 32 and 33.
/// @param values the present modality [batch x D_present]
MeanFieldTrace mean_field(const Mrbm& model, int present, const MatrixD& values,
                          const MeanFieldOptions& options = {});

/// A loss and its gradient (downhill is minus it), both means over the batch.
struct MultiPrediction {
  double loss = 0;
  Mrbm gradient;
};

/// Multi-prediction training of eq 42: the cross-entropy of each modality predicted from the other,
/// summed over both directions and all units, back-propagated through the unrolled mean field.
MultiPrediction multi_prediction(const Mrbm& model, const std::array<MatrixD, 2>& batch,
                                 const MeanFieldOptions& options = {});

}  // namespace mcdbn::reference
