#pragma once

#include <vector>

#include "mcdbn/machines/mrbm.hpp"

namespace mcdbn {

/// The free energy of modality m given the others, one a row: what of F (eq 19, hidden units summed
/// out) changes with its units.
/// @param units of every modality [rows x visible], not indexed  @param out [rows x 1]
void free_energy_given_others(const Mrbm& mrbm, std::size_t m, const std::vector<Rows>& units,
                              const Matrix& out);

/// out[r] = weight where x[r] < y[r], else 0. @param x, y, out [rows x 1]
void weigh_lower(const Matrix& x, const Matrix& y, float weight, const Matrix& out);

}  // namespace mcdbn
