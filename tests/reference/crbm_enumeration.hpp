#pragma once

#include "reference/crbm_reference.hpp"

/// Exact likelihood of a tiny CRBM by summing over all 2^H hidden states (the visible units are
/// integrated or summed out in closed form).
namespace mcdbn::reference {

/// Mean over the batch of log p(v^t | H^t), eq 4 and 13.
double log_likelihood(const Crbm& model, const CrbmBatch& batch);

/// Its gradient: eq 37 to 41 with ⟨·⟩rec replaced by the model's own expectation.
Crbm exact_gradient(const Crbm& model, const CrbmBatch& batch);

}  // namespace mcdbn::reference
