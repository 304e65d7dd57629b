#include "mcdbn/base/column_scale.hpp"

#include <cmath>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

/// Sums of f(value, column) over what is known, for each column.
template <typename F>
RowVectorD column_sums(std::span<const MatrixF> data, Eigen::Index columns, F&& f) {
  RowVectorD sums = RowVectorD::Zero(columns);
  for (const MatrixF& values : data)
    for (Eigen::Index r = 0; r < values.rows(); ++r)
      for (Eigen::Index c = 0; c < columns; ++c)
        if (!std::isnan(values(r, c))) sums(c) += f(static_cast<double>(values(r, c)), c);
  return sums;
}

void require_columns(const MatrixF& values, const RowVectorF& mean) {
  if (values.cols() != mean.cols()) throw ShapeError("scale: the data have other columns");
}

}  // namespace

ColumnScale ColumnScale::of(std::span<const MatrixF> data) {
  const Eigen::Index columns = data.empty() ? 0 : data.front().cols();
  for (const MatrixF& values : data)
    if (values.cols() != columns) throw ShapeError("scale: matrices differ in columns");
  const RowVectorD count =
      column_sums(data, columns, [](double, Eigen::Index) { return 1.0; }).cwiseMax(1.0);
  const RowVectorD mean =
      column_sums(data, columns, [](double x, Eigen::Index) { return x; }).cwiseQuotient(count);
  const RowVectorD variance = column_sums(data, columns, [&](double x, Eigen::Index c) {
                                return (x - mean(c)) * (x - mean(c));
                              }).cwiseQuotient(count);
  const RowVectorD deviation = variance.cwiseSqrt();
  return {mean.cast<float>(),
          (deviation.array() > 0.0).select(deviation, RowVectorD::Ones(columns)).cast<float>()};
}

MatrixF ColumnScale::apply(const MatrixF& values) const {
  require_columns(values, mean);
  return ((values.rowwise() - mean).array().rowwise() / deviation.array()).matrix();
}

MatrixF ColumnScale::undo(const MatrixF& scaled) const {
  require_columns(scaled, mean);
  return ((scaled.array().rowwise() * deviation.array()).matrix().rowwise() + mean);
}

}  // namespace mcdbn
