#pragma once

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

/// Standardized values with 0, the training mean, where nothing is known (NaN).
MatrixF at_mean_where_unknown(const MatrixF& standardized);

}  // namespace mcdbn
