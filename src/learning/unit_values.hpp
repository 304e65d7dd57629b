#pragma once

#include <span>
#include <string>

#include "mcdbn/base/matrices.hpp"
#include "mcdbn/machines/crbm.hpp"
#include "mcdbn/machines/mrbm.hpp"
#include "mcdbn/machines/sequences.hpp"

namespace mcdbn {

/// Checks what visible units of this kind can take: numbers throughout, binary units from 0 to 1.
/// @param what file or modality, for errors  @param may_be_unknown whether NaN is let through
/// @throws InputError naming row and column, counted from 1
void check_unit_values(const MatrixF& values, VisibleKind kind, const std::string& what,
                       bool may_be_unknown = false);

/// As check_unit_values() of a matrix, for the rows that have values; rows are counted over all
/// sequences.
void check_unit_values(const Sequences& data, VisibleKind kind, const std::string& what);

/// Checks that an MRBM can learn from these: sequences for each modality, of its columns and of the
/// same clips, and values as check_unit_values has them.
/// @throws ShapeError, InputError
void check_codes(std::span<const Sequences> codes, std::span<const Modality> modalities);

}  // namespace mcdbn
