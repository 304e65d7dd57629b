#pragma once

#include <span>

#include "device/row_tile.hpp"
#include "mcdbn/machines/mrbm.hpp"

namespace mcdbn {

/// Padded units of all modalities together: the floats of a row in the fused kernels' stacks.
std::size_t all_units(const Mrbm& mrbm);

/// Work-groups for the gradients of every W (update_panels).
std::size_t all_panels(const Mrbm& mrbm, const RowTile& tile);

/// Every modality's codes into the stack that the fused kernels read (multi_prediction.cl,
/// joint_likelihood.cl): one modality after another, `block` padded rows each.
/// @param codes as many rows of each, at most `block`  @param stack [1 x block · all_units()]
void gather_codes(std::span<const Rows> codes, std::size_t block, const Matrix& stack);

}  // namespace mcdbn
