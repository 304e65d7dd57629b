#include "base/missing_values.hpp"

namespace mcdbn {

MatrixF at_mean_where_unknown(const MatrixF& standardized) {
  return standardized.array().isNaN().select(0.0F, standardized);
}

}  // namespace mcdbn
