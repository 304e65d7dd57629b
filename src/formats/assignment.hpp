#pragma once

#include <vector>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

/// The assignment of rows to columns, each used once at most, of the smallest sum of costs: the
/// Hungarian method with potentials (Kuhn 1955, Munkres 1957; shortest augmenting paths after
/// Jonker and Volgenant 1987), O(rows² · columns).
/// @param costs [rows x columns], finite
/// @throws Interrupted
/// @return [rows] the column of each, -1 where there are fewer columns than rows
std::vector<int> cheapest_assignment(const MatrixD& costs);

}  // namespace mcdbn
