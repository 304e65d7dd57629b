#include "fitting/rows_around.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace mcdbn;

namespace {

/// One row of numbers a row, the second column 10 more.
MatrixD two_columns(const std::vector<double>& first) {
  MatrixD values(static_cast<Eigen::Index>(first.size()), 2);
  for (Eigen::Index t = 0; t < values.rows(); ++t) {
    values.row(t) << first[static_cast<std::size_t>(t)], first[static_cast<std::size_t>(t)] + 10;
  }
  return values;
}

}  // namespace

TEST_CASE("rows around: a mean weighs by distance and leaves the row itself out") {
  const double near = std::exp(-0.5 / 4), far = std::exp(-0.5);
  const RowVectorD mean = mean_around(two_columns({5, 1, 1e6, 3, 2}), 2, 2);
  const double expected = (near * (1 + 3) + far * (5 + 2)) / (2 * near + 2 * far);
  CHECK(mean[0] == doctest::Approx(expected).epsilon(1e-12));
  CHECK(mean[1] == doctest::Approx(expected + 10).epsilon(1e-12));
  // At the end there is one side only, and past three deviations nothing counts.
  CHECK(mean_around(two_columns({9, 4, 4, 1e6}), 0, 0.5)[0] == doctest::Approx(4).epsilon(1e-12));
}

TEST_CASE("rows around: a median is what most weight is behind, however far off the rest") {
  const MatrixD values = two_columns({2, 1e6, 0, 3, -1e6, 2.5, 1e9});
  // Weights by distance from row 2: .61 .88 – .88 .61 .32 .14, half of them 1.72.
  const RowVectorD median = median_around(values, 2, 2);
  CHECK(median[0] == 3);
  CHECK(median[1] == 13);
  CHECK(median_around(two_columns({7, 1}), 0, 1)[0] == 1);
}

TEST_CASE("rows around: smoothing keeps a constant and spreads an impulse") {
  const MatrixD constant = MatrixD::Constant(9, 3, 1.25);
  CHECK((smoothed_rows(constant, 1.5) - constant).cwiseAbs().maxCoeff() < 1e-15);
  // A single one becomes the Gaussian, whose weights sum to one.
  MatrixD impulse = MatrixD::Zero(21, 1);
  impulse(10, 0) = 1;
  const MatrixD spread = smoothed_rows(impulse, 1);
  double total = 0;
  for (int k = -3; k <= 3; ++k) total += std::exp(-0.5 * k * k);
  for (Eigen::Index k = -4; k <= 4; ++k) {
    const double expected = k == -4 || k == 4 ? 0 : std::exp(-0.5 * static_cast<double>(k * k));
    CHECK(spread(10 + k, 0) == doctest::Approx(expected / total).epsilon(1e-12));
  }
}
