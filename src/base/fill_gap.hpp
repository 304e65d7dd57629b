#pragma once

#include <Eigen/Core>

namespace mcdbn {

/// Fills rows first … last−1 from the straight line between the rows on both sides, or with the one
/// that there is. One of them has to be there.
template <typename Rows>
void fill_gap(Eigen::MatrixBase<Rows>& rows, Eigen::Index first, Eigen::Index last) {
  using Scalar = typename Rows::Scalar;
  const bool has_left = first > 0, has_right = last < rows.rows();
  const auto left = rows.row(has_left ? first - 1 : last).eval();
  const auto right = rows.row(has_right ? last : first - 1).eval();
  const auto step = ((right - left) / static_cast<Scalar>(last - first + 1)).eval();
  for (Eigen::Index row = first; row < last; ++row)
    rows.row(row) = left + step * static_cast<Scalar>(row - first + 1);
}

}  // namespace mcdbn
