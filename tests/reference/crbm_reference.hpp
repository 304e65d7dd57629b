#pragma once

#include <functional>

#include "device/optimizer.hpp"
#include "mcdbn/base/matrices.hpp"

namespace mcdbn::reference {

enum class VisibleUnits { gaussian, binary };

/// Parameters of a CRBM with D visible and H hidden units that sees n past frames (σ = 1), A or
/// B perhaps fewer, the latest of them; with n = 0 an RBM. Gradients and velocities have the same
/// shapes and use this type too.
struct Crbm {
  VisibleUnits visible_units = VisibleUnits::gaussian;
  MatrixD weights;          ///< W [D x H]
  MatrixD visible_history;  ///< A [n·D x D], rows as in a history
  MatrixD hidden_history;   ///< B [n·D x H]
  RowVectorD visible_bias;  ///< a [D]
  RowVectorD hidden_bias;   ///< b [H]

  /// All parameters behind one another, for sums, differences and finite differences.
  Eigen::VectorXd flattened() const;
  /// A CRBM of this one's kind and shapes with those parameters.
  Crbm with_parameters(const Eigen::VectorXd& flat) const;
};

/// A mini-batch. A history row is the past n frames, oldest first, side by side (eq 15).
struct CrbmBatch {
  MatrixD visible;  ///< v^t [batch x D]
  MatrixD history;  ///< H^t [batch x n·D]
  /// What was seen of `visible`, 1 or 0; the rest is 0 in the data and stays so. Empty: all of it.
  /// Only CdTraining uses it.
  MatrixD seen = {};
};

/// â, eq 16. @return [batch x D]
MatrixD dynamic_visible_bias(const Crbm& model, const MatrixD& history);
/// b̂, eq 17. @return [batch x H]
MatrixD dynamic_hidden_bias(const Crbm& model, const MatrixD& history);
/// p(h = 1 | v, H), eq 11 (eq 7 for binary visible units). @return [batch x H]
MatrixD hidden_probability(const Crbm& model, const MatrixD& visible,
                           const MatrixD& dynamic_hidden_bias);
/// Mean of v given h and H, eq 10 (eq 6 for binary visible units). @return [batch x D]
MatrixD visible_mean(const Crbm& model, const MatrixD& hidden, const MatrixD& dynamic_visible_bias);

/// The statistics ⟨·⟩ of eq 37 to 41 summed over the batch.
Crbm statistics(const Crbm& model, const CrbmBatch& batch, const MatrixD& visible,
                const MatrixD& hidden);

/// Uniform numbers [batch x H] for the draw of the hidden units before Gibbs step 0, 1, …, k − 1.
using HiddenDraws = std::function<MatrixD(int gibbs_step)>;

struct CdResult {
  Crbm gradient;   ///< ⟨·⟩data − ⟨·⟩rec of eq 37 to 41, mean over the batch, uphill
  MatrixD hidden;  ///< p(h | data, H) [batch x H]
  MatrixD reconstruction;         ///< the last visible means [batch x D]
  MatrixD reconstruction_hidden;  ///< p(h | reconstruction, H)
  double closest_draw = 1.0;      ///< smallest |p − u| of all draws
};

/// CD-k (eq 36 to 41): the data are clamped once, then k Gibbs steps; hidden units are drawn,
/// visible reconstructions are means, and the last hidden step uses probabilities.
CdResult contrastive_divergence(const Crbm& model, const CrbmBatch& batch, int k,
                                const HiddenDraws& draws);

/// One update of all parameters, each by its own rule; the biases by that of W without decay.
void update(Crbm& model, Crbm& velocity, const Crbm& gradient, const UpdateRule& rule_W,
            const UpdateRule& rule_A, const UpdateRule& rule_B);

}  // namespace mcdbn::reference
