#pragma once

#include <span>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

/// Standardizes columns: (value - mean) / deviation, as Gaussian units of variance 1 need.
struct ColumnScale {
  RowVectorF mean, deviation;

  /// Over all rows of all matrices; NaN does not count. A column that never changes has deviation
  /// 1. @throws ShapeError if the matrices differ in columns
  static ColumnScale of(std::span<const MatrixF> data);
  MatrixF apply(const MatrixF& values) const;  ///< @throws ShapeError
  MatrixF undo(const MatrixF& scaled) const;   ///< @throws ShapeError
};

}  // namespace mcdbn
