#pragma once

#include <vector>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

/// A Gaussian around row `t` of so many, cut off where it is next to nothing.
struct RowsAround {
  RowsAround(Eigen::Index rows, Eigen::Index t, double deviation_rows);
  /// The same, of the others only: the row itself weighs nothing.
  static RowsAround without_itself(Eigen::Index rows, Eigen::Index t, double deviation_rows);

  Eigen::Index first;
  std::vector<double> weights;  ///< of the rows from the first on
};

/// Mean of the rows around row `t` but not itself, weighted by a Gaussian of that deviation.
/// @param values [rows x columns], two rows at least
RowVectorD mean_around(const MatrixD& values, Eigen::Index t, double deviation_rows);

/// The same rows' weighted median, column by column: what most say, however far off the others are.
RowVectorD median_around(const MatrixD& values, Eigen::Index t, double deviation_rows);

/// Every row's mean of itself and those around it. @return [rows x columns]
MatrixD smoothed_rows(const MatrixD& values, double deviation_rows);

}  // namespace mcdbn
