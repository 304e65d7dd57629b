// Standardizing the columns of data, and back.

#include "mcdbn/base/column_scale.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "base/random_matrix.hpp"
#include "mcdbn/base/errors.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

TEST_CASE("a scale gives each column mean 0 and deviation 1 over all matrices, and back") {
  std::vector<MatrixF> data;
  data.push_back(random_matrix(40, 3, 1));
  data.push_back(random_matrix(25, 3, 2));
  for (MatrixF& values : data) {
    values.col(0) = (5.0F + 3.0F * values.col(0).array()).matrix();
    values.col(2).setConstant(0.1F);
  }
  const ColumnScale scale = ColumnScale::of(data);
  CHECK(scale.mean(2) == 0.1F);
  CHECK(scale.deviation(2) == 1.0F);
  MatrixF all(65, 3);
  all << scale.apply(data[0]), scale.apply(data[1]);
  CHECK(all.colwise().mean().cwiseAbs().maxCoeff() < 1e-6F);
  for (const int c : {0, 1}) CHECK(std::abs(all.col(c).squaredNorm() / 65.0F - 1.0F) < 1e-5F);
  CHECK(all.col(2).isZero(0.0F));
  CHECK((scale.undo(all).topRows(40) - data[0]).cwiseAbs().maxCoeff() < 2e-6F);
}

TEST_CASE("a scale passes over what is unknown; what does not fit is refused") {
  MatrixF values(3, 2);
  const float unknown = std::numeric_limits<float>::quiet_NaN();
  values << 1, 7, unknown, 7, 3, unknown;
  const ColumnScale scale = ColumnScale::of(std::vector<MatrixF>(1, values));
  CHECK(scale.mean(0) == 2.0F);
  CHECK(scale.mean(1) == 7.0F);
  CHECK(scale.deviation(0) == 1.0F);
  CHECK(scale.deviation(1) == 1.0F);
  CHECK(std::isnan(scale.apply(values)(1, 0)));
  CHECK(scale.apply(values)(2, 0) == 1.0F);
  CHECK_THROWS_AS(scale.apply(MatrixF::Zero(2, 3)), ShapeError);
  CHECK_THROWS_AS(scale.undo(MatrixF::Zero(2, 1)), ShapeError);
  std::vector<MatrixF> uneven(2, values);
  uneven[1] = MatrixF::Zero(1, 3);
  CHECK_THROWS_AS(ColumnScale::of(uneven), ShapeError);
}
