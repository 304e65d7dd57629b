#pragma once

#include <string>
#include <vector>

#include "matrix_options.hpp"
#include "mcdbn/base/column_scale.hpp"
#include "mcdbn/machines/crbm.hpp"

namespace mcdbn::cli {

/// Checks the data of one modality, and scales them if that is asked for.
/// @param files of the data, for errors
/// @return the scale; empty if the data stay as they are  @throws InputError
ColumnScale prepare(std::vector<MatrixF>& data, const MatrixInput& files, VisibleKind kind,
                    bool standardize);

/// Which column has a mean or a deviation that Gaussian units of deviation 1 cannot learn, in
/// words; empty if none has.
/// @param learns_deviation whether the units' deviation is learnt
std::string far_from_standardized(const std::vector<MatrixF>& data, const MatrixInput& files,
                                  bool learns_deviation);

}  // namespace mcdbn::cli
