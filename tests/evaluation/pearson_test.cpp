#include "mcdbn/evaluation/pearson.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "clips.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

MatrixD random_clip(int frames, int channels, unsigned seed) {
  return test::random_clip(frames, channels, 1, seed);
}

/// The textbook one-pass sums in long double: another formula than the library's.
double naive_pearson(const MatrixD& a, const MatrixD& b) {
  long double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
  for (Eigen::Index i = 0; i < a.rows(); ++i)
    for (Eigen::Index j = 0; j < a.cols(); ++j) {
      const long double u = a(i, j), v = b(i, j);
      n += 1, x += u, y += v, xx += u * u, yy += v * v, xy += u * v;
    }
  return static_cast<double>((n * xy - x * y) / std::sqrt((n * xx - x * x) * (n * yy - y * y)));
}

}  // namespace

TEST_CASE("pearson: small cases by hand") {
  const Eigen::Vector4d x(1, 2, 3, 4);
  CHECK(pearson(x, Eigen::Vector4d(1, 3, 2, 4)) == doctest::Approx(0.8).epsilon(1e-12));
  CHECK(pearson(x, Eigen::Vector4d(5, 3, 1, -1)) == doctest::Approx(-1).epsilon(1e-12));
  CHECK(pearson(x, Eigen::Vector4d(1, -1, -1, 1)) == doctest::Approx(0).epsilon(1e-12));
  CHECK(std::isnan(pearson(x, Eigen::Vector4d::Constant(0.1))));
  CHECK(std::isnan(pearson(x, Eigen::Vector4d(1, 2, NAN, 4))));
  CHECK_THROWS_AS(pearson(x, Eigen::Vector3d(1, 2, 3)), ShapeError);
}

TEST_CASE("pearson: a large common offset costs no accuracy") {
  const Eigen::VectorXd x = random_clip(500, 1, 1), y = x + 0.5 * random_clip(500, 1, 2).col(0);
  const Eigen::VectorXd moved = x.array() + 1e7;
  CHECK(pearson(moved, y) == doctest::Approx(pearson(x, y)).epsilon(1e-7));
}

TEST_CASE("pearson_flat and pearson_per_channel equal naive loops") {
  for (const unsigned seed : {3U, 4U, 5U}) {
    MatrixD truth = random_clip(57, 7, seed);
    for (int column = 0; column < 7; ++column) truth.col(column).array() += 10.0 * column;
    const MatrixD regenerated = truth + 0.7 * random_clip(57, 7, seed + 100);
    CHECK(pearson_flat(truth, regenerated) ==
          doctest::Approx(naive_pearson(truth, regenerated)).epsilon(1e-10));
    double sum = 0;
    for (int column = 0; column < 7; ++column)
      sum += naive_pearson(truth.col(column), regenerated.col(column));
    CHECK(pearson_per_channel(truth, regenerated) == doctest::Approx(sum / 7).epsilon(1e-10));
  }
}

TEST_CASE("pearson_per_channel: constant columns") {
  MatrixD truth = random_clip(20, 4, 9);
  MatrixD regenerated = truth;
  truth.col(1).setConstant(0.1);        // does not count, whatever the regeneration does there
  regenerated.col(2).setConstant(0.3);  // counts as 0
  CHECK(pearson_per_channel(truth, regenerated) == doctest::Approx(2.0 / 3.0).epsilon(1e-12));
  truth.col(1) += 1e-13 * random_clip(20, 1, 10);  // rounding is no change
  CHECK(pearson_per_channel(truth, regenerated) == doctest::Approx(2.0 / 3.0).epsilon(1e-12));
  CHECK(std::isnan(pearson_per_channel(MatrixD::Ones(5, 2), MatrixD::Ones(5, 2))));
  CHECK_THROWS_AS(pearson_per_channel(truth, truth.topRows(3)), ShapeError);
}

TEST_CASE("a constant mean pose scores high flattened and nothing per channel") {
  MatrixD truth = 0.1 * random_clip(40, 5, 11);
  truth.rowwise() += RowVectorD::LinSpaced(5, -10, 10);
  const MatrixD mean_pose = truth.colwise().mean().replicate(40, 1);
  CHECK(pearson_flat(truth, mean_pose) > 0.99);
  CHECK(pearson_per_channel(truth, mean_pose) == 0);
}

}  // namespace mcdbn
