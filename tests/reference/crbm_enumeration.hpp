#pragma once

#include "reference/crbm_reference.hpp"

/// Exact quantities of a tiny CRBM by summing over all 2^H hidden states (the visible units are
/// integrated or summed out in closed form), and of tiny binary ones over all 2^D visible states.
namespace mcdbn::reference {

/// Every state of so many binary units, one a row: unit j is bit j of the row's number.
MatrixD all_states(Eigen::Index units);

/// F(v | H) of each row, eq 9 and 14 with their erratum (eq 2 for binary units). @return [batch x
/// 1]
MatrixD free_energy(const Crbm& model, const CrbmBatch& batch);

/// log Σ_h ∫ exp(−E(v, h | H)) dv of each history (a sum over v for binary units). @return [batch]
Eigen::VectorXd log_partition(const Crbm& model, const MatrixD& history);

/// p(h | H) of all_states(hidden units). @param history [1 x n·D]  @return [2^H]
Eigen::VectorXd hidden_distribution(const Crbm& model, const MatrixD& history);

/// p(v | H) of all_states(visible units) of a binary machine. @return [2^D]
Eigen::VectorXd visible_distribution(const Crbm& model, const MatrixD& history);

/// Mean over the batch of log p(v^t | H^t), eq 4 and 13.
double log_likelihood(const Crbm& model, const CrbmBatch& batch);

/// The statistics of eq 37 to 41 under the model's own p(v, h | H), summed over the histories.
Crbm expected_statistics(const Crbm& model, const MatrixD& history);

/// The likelihood's gradient: eq 37 to 41 with ⟨·⟩rec replaced by the model's own expectation.
Crbm exact_gradient(const Crbm& model, const CrbmBatch& batch);

}  // namespace mcdbn::reference
