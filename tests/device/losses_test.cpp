#include "device/losses.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "device/every_device.hpp"
#include "mcdbn/base/errors.hpp"
#include "reference/error_bounds.hpp"
#include "reference/loss_error_bound.hpp"

namespace losses_test {

using namespace mcdbn;
using namespace mcdbn::test;
using reference::Bounded;

namespace {

void check_within(float got, const Bounded& want) {
  CHECK(reference::misfit(MatrixF::Constant(1, 1, got), want.value, want.bound) == "");
}

void check_losses(Device& device, std::size_t rows, std::size_t columns) {
  CAPTURE(rows);
  CAPTURE(columns);
  const MatrixF x = random_matrix(rows + 1, columns, 1).cwiseAbs();
  MatrixF y = random_matrix(rows + 2, columns, 2).cwiseAbs();
  y(2, 0) = 1.0F;  // saturated predictions cost much, but not infinitely much
  y(rows + 1, columns - 1) = 0.0F;
  const Matrix x_device = Matrix::from_host(device, x), y_device = Matrix::from_host(device, y);
  const Rows x_rows(x_device, 1, rows), y_rows(y_device, 2, rows);
  const auto exact = [rows](const MatrixF& of) {
    return Bounded::exact(of.bottomRows(static_cast<Eigen::Index>(rows)).cast<double>());
  };
  const Bounded squared = reference::squared_error(exact(x), exact(y));
  const Bounded entropy = reference::cross_entropy(exact(x), exact(y));

  LossAccumulator losses(device, 3, rows + 5);
  losses.add_squared_error(0, x_rows, y_rows, 1.0F);
  losses.add_cross_entropy(2, x_rows, y_rows, 1.0F);
  const auto sums = losses.read_and_reset();
  REQUIRE(sums.size() == 3);
  check_within(sums[0], squared);
  CHECK(sums[1] == 0.0F);
  check_within(sums[2], entropy);

  // Twice over: the same bits. Two additions to one slot: their sum.
  losses.add_squared_error(0, x_rows, y_rows, 1.0F);
  losses.add_cross_entropy(2, x_rows, y_rows, 1.0F);
  losses.add_squared_error(1, x_rows, y_rows, 0.5F);
  losses.add_squared_error(1, x_rows, y_rows, 0.25F);
  const auto again = losses.read_and_reset();
  CHECK(again[0] == sums[0]);
  CHECK(again[2] == sums[2]);
  check_within(again[1], 0.5 * squared + 0.25 * squared);
}

}  // namespace

TEST_CASE("small: squared error and cross-entropy, in a fixed order") {
  on_every_device([](Device& device) {
    check_losses(device, 1, 1);
    check_losses(device, 3, 3);
    check_losses(device, 7, 17);
    check_losses(device, 13, 5);
  });
}

TEST_CASE("squared error and cross-entropy at the model's sizes") {
  on_every_device([](Device& device) {
    check_losses(device, 100, 96);
    check_losses(device, 100, 190);
    check_losses(device, 100, 300);
  });
}

TEST_CASE("small: a factor scales the differences of its column") {
  on_every_device([](Device& device) {
    constexpr std::size_t kRows = 7, kColumns = 5;
    const MatrixF x = random_matrix(kRows, kColumns, 3), y = random_matrix(kRows, kColumns, 4);
    // Powers of two, so that scaling rounds nothing.
    MatrixF factor(1, kColumns);
    factor << 2.0F, 0.5F, 1.0F, 8.0F, 0.25F;
    const auto scaled = [&](const MatrixF& of) {
      return MatrixF((of.array().rowwise() * factor.row(0).array()).matrix());
    };
    const auto on_device = [&](const MatrixF& host) { return Matrix::from_host(device, host); };
    const Matrix of_columns = on_device(factor), ones = on_device(MatrixF::Ones(1, kColumns));
    LossAccumulator losses(device, 4, kRows);
    losses.add_squared_error(0, on_device(x), on_device(y), 0.5F, &of_columns);
    losses.add_squared_error(1, on_device(scaled(x)), on_device(scaled(y)), 0.5F);
    losses.add_squared_error(2, on_device(x), on_device(y), 0.5F, &ones);
    losses.add_squared_error(3, on_device(x), on_device(y), 0.5F);
    const auto sums = losses.read_and_reset();
    CHECK(sums[0] == sums[1]);
    CHECK(sums[2] == sums[3]);
    CHECK(sums[0] != sums[3]);
    const Matrix narrow = on_device(MatrixF::Ones(1, kColumns - 1));
    CHECK_THROWS_AS(losses.add_squared_error(0, on_device(x), on_device(y), 1.0F, &narrow),
                    ShapeError);
  });
}

TEST_CASE("small: a NaN in target or prediction shows in the loss") {
  on_every_device([](Device& device) {
    MatrixF bad = MatrixF::Constant(3, 5, 0.5F);
    const Matrix good_device = Matrix::from_host(device, bad);
    bad(1, 4) = std::numeric_limits<float>::quiet_NaN();
    const Matrix bad_device = Matrix::from_host(device, bad);
    LossAccumulator losses(device, 4, 3);
    losses.add_squared_error(0, good_device, bad_device, 1.0F);
    losses.add_squared_error(1, bad_device, good_device, 1.0F);
    losses.add_cross_entropy(2, good_device, bad_device, 1.0F);
    losses.add_cross_entropy(3, bad_device, good_device, 1.0F);
    for (const float sum : losses.read_and_reset()) CHECK(std::isnan(sum));
  });
}

TEST_CASE("small: losses refuse other shapes, slots and batches than they were made for") {
  on_every_device([](Device& device) {
    const Matrix x(device, 4, 5), y(device, 4, 6);
    LossAccumulator losses(device, 1, 3);
    CHECK_THROWS_AS(losses.add_squared_error(0, Rows(x, 0, 3), Rows(y, 0, 3), 1.0F), ShapeError);
    CHECK_THROWS_AS(losses.add_squared_error(1, Rows(x, 0, 3), Rows(x, 0, 3), 1.0F), ShapeError);
    CHECK_THROWS_AS(losses.add_squared_error(0, x, x, 1.0F), ShapeError);
  });
}

}  // namespace losses_test
