#pragma once

#include <functional>

#include "device/optimizer.hpp"
#include "reference/crbm_reference.hpp"

/// Contrastive divergence with what the paper leaves out: persistent chains and fast weights, drawn
/// visible units, a target for the hidden units' activity, L1, Adam, and a deviation of the visible
/// units.
namespace mcdbn::reference {

struct CdOptions {
  int gibbs_steps = 1;
  UpdateRule W, A, B;
  bool adam = false;
  bool sample_visible = false;
  double sparsity_target = 0.1, sparsity_strength = 0.0;
  bool persistent = false;
  double fast_rate = 0.0;
  double deviation_rate = 0.0;
};

/// The draws of a mini-batch before or in Gibbs step 0, 1, …: uniform numbers for binary units,
/// standard normal ones for Gaussian units.
struct ChainDraws {
  std::function<MatrixD(int gibbs_step)> hidden, visible;
};

/// A CRBM in training, with all that goes on from one mini-batch to the next.
struct CdTraining {
  explicit CdTraining(const Crbm& start);
  void step(const CrbmBatch& batch, const CdOptions& options, const ChainDraws& draws);

  Crbm model;
  RowVectorD deviation;       ///< σ of the visible units [D]
  MatrixD particles;          ///< hidden units of persistent chains [batch x H]
  Crbm fast;                  ///< fast parts of W, a and b
  Crbm gradient;              ///< of the last step, uphill
  double loss = 0;            ///< of the last step, in the data's units
  double closest_draw = 1.0;  ///< smallest |p − u| of all draws so far

 private:
  void update(const CdOptions& options);

  Crbm velocity_, square_;
  RowVectorD activity_;
  int steps_ = 0;
};

}  // namespace mcdbn::reference
