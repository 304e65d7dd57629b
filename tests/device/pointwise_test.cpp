#include "device/pointwise.hpp"

#include <doctest/doctest.h>

#include "device/every_device.hpp"
#include "mcdbn/base/errors.hpp"
#include "reference/error_bounds.hpp"
#include "reference/running_error.hpp"

namespace pointwise_test {

using namespace mcdbn;
using namespace mcdbn::test;
using reference::Bounded;
using reference::exact;

namespace {

struct Size {
  std::size_t rows, columns;
};
const std::vector<Size> kSmallSizes = {{1, 1}, {3, 3}, {1, 17}, {17, 1}, {7, 13}, {5, 33}};
const std::vector<Size> kModelSizes = {{100, 96}, {100, 190}, {100, 300}, {480, 300}, {101, 149}};

void check_within(const MatrixF& got, const Bounded& want) {
  CHECK(reference::misfit(got, want.value, want.bound) == "");
}

void check_difference(Device& device, const Size& size) {
  CAPTURE(size.rows);
  CAPTURE(size.columns);
  const MatrixF x = random_matrix(size.rows + 2, size.columns, 1);
  const MatrixF y = random_matrix(size.rows + 1, size.columns, 2);
  const Matrix x_device = Matrix::from_host(device, x), y_device = Matrix::from_host(device, y);
  const GuardedBlock out(device, size.rows, size.columns);
  scaled_difference(Rows(x_device, 2, size.rows), Rows(y_device, 1, size.rows), 0.3F, out.rows());
  const auto rows = static_cast<Eigen::Index>(size.rows);
  check_within(out.values(),
               double{0.3F} * (exact(x.bottomRows(rows)) - exact(y.bottomRows(rows))));
  CHECK(out.intact());
}

void check_transpose(Device& device, const Size& size) {
  CAPTURE(size.rows);
  CAPTURE(size.columns);
  const MatrixF in = random_matrix(size.rows, size.columns, 3);
  Matrix out(device, size.columns, size.rows);
  transpose(Matrix::from_host(device, in), out);
  CHECK(out.to_host() == in.transpose());
  CHECK(padding_is_zero(out));
}

/// Blocks of a history's weights, oldest frame first, against those for the frames that follow.
void check_transpose_lags(Device& device, const Size& size, std::size_t lags) {
  CAPTURE(size.rows);
  CAPTURE(size.columns);
  CAPTURE(lags);
  const auto rows = static_cast<Eigen::Index>(size.rows),
             columns = static_cast<Eigen::Index>(size.columns),
             wide = static_cast<Eigen::Index>(padded(size.rows)),
             wide_out = static_cast<Eigen::Index>(padded(size.columns));
  const MatrixF blocks = random_matrix(lags * size.rows, size.columns, 6);
  MatrixF in = MatrixF::Zero(static_cast<Eigen::Index>(lags) * wide, columns);
  MatrixF want = MatrixF::Zero(static_cast<Eigen::Index>(lags) * wide_out, rows);
  for (Eigen::Index q = 0; q < static_cast<Eigen::Index>(lags); ++q) {
    in.middleRows(q * wide, rows) = blocks.middleRows(q * rows, rows);
    want.middleRows((static_cast<Eigen::Index>(lags) - 1 - q) * wide_out, columns) =
        blocks.middleRows(q * rows, rows).transpose();
  }
  Matrix out(device, lags * padded(size.columns), size.rows);
  transpose_lags(Matrix::from_host(device, in), lags, out);
  CHECK(out.to_host() == want);
  CHECK(padding_is_zero(out));
}

void check_column_sum(Device& device, const Size& size, float beta) {
  CAPTURE(size.rows);
  CAPTURE(size.columns);
  CAPTURE(beta);
  const MatrixF in = random_matrix(size.rows + 1, size.columns, 4);
  const MatrixF before = random_matrix(1, size.columns, 5);
  const Matrix in_device = Matrix::from_host(device, in);
  Matrix out = Matrix::from_host(device, before), again = Matrix::from_host(device, before);
  column_sum(Rows(in_device, 1, size.rows), -0.7F, beta, out);
  column_sum(Rows(in_device, 1, size.rows), -0.7F, beta, again);
  const auto rows = static_cast<Eigen::Index>(size.rows);
  check_within(out.to_host(), double{-0.7F} * column_sum(exact(in.bottomRows(rows))) +
                                  double{beta} * exact(before));
  CHECK(out.to_host() == again.to_host());
  CHECK(padding_is_zero(out));
}

void check_block_sum(Device& device, const Size& size, std::size_t blocks) {
  CAPTURE(size.rows);
  CAPTURE(size.columns);
  CAPTURE(blocks);
  const MatrixF in = random_matrix(blocks * size.rows, size.columns, 6);
  const Matrix in_device = Matrix::from_host(device, in);
  const Matrix out(device, size.rows, size.columns);
  block_sum(in_device, out);
  const auto rows = static_cast<Eigen::Index>(size.rows);
  reference::Sum want;
  for (Eigen::Index t = 0; t < static_cast<Eigen::Index>(blocks); ++t)
    want.add(exact(in.middleRows(t * rows, rows)));
  check_within(out.to_host(), want.result());
  CHECK(padding_is_zero(out));
}

void check_all(Device& device, const Size& size) {
  check_difference(device, size);
  check_transpose(device, size);
  for (const std::size_t lags : {1U, 3U}) check_transpose_lags(device, size, lags);
  for (const float beta : {0.0F, 1.0F, -0.5F}) check_column_sum(device, size, beta);
  for (const std::size_t blocks : {1U, 3U, 10U}) check_block_sum(device, size, blocks);
}

}  // namespace

TEST_CASE("small: differences, transposes and sums over rows and blocks") {
  on_every_device([](Device& device) {
    for (const auto& size : kSmallSizes) check_all(device, size);
  });
}

TEST_CASE("differences, transposes and sums over rows and blocks at the model's sizes") {
  on_every_device([](Device& device) {
    for (const auto& size : kModelSizes) check_all(device, size);
  });
}

TEST_CASE("small: a sum that is not added to takes no notice of what was there") {
  on_every_device([](Device& device) {
    const Matrix in = Matrix::from_host(device, MatrixF::Constant(2, 3, 1.5F));
    Matrix out =
        Matrix::from_host(device, MatrixF::Constant(1, 3, std::numeric_limits<float>::quiet_NaN()));
    column_sum(in, 1.0F, 0.0F, out);
    CHECK(out.to_host() == MatrixF::Constant(1, 3, 3.0F));
  });
}

TEST_CASE("small: gather picks single rows in any order") {
  on_every_device([](Device& device) {
    const MatrixF frames = random_matrix(9, 19, 7);
    const Matrix frames_device = Matrix::from_host(device, frames);
    const IndexBuffer index(device, {8, 8, 0, 5, 1});
    const GuardedBlock out(device, 3, 19);
    gather(Rows::indexed(frames_device, index, 1, 3), out.rows());
    MatrixF want(3, 19);
    want << frames.row(8), frames.row(0), frames.row(5);
    CHECK(out.values() == want);
    CHECK(out.intact());
    gather(Rows::indexed(frames_device, index, 3, 2, 1), Rows(out.matrix(), 2, 2));
    CHECK(out.values().row(0) == frames.row(6));
    CHECK(out.values().row(1) == frames.row(2));
  });
}

TEST_CASE("small: drop-out keeps what the host's draws keep, and what is expected stays") {
  on_every_device([](Device& device) {
    const RandomKey key{.seed = 5, .step = 2, .stream = 9, .phase = 1};
    for (const auto& [rows, columns] : {std::pair{1, 1}, {5, 17}, {13, 33}}) {
      const MatrixF x = random_matrix(rows, columns, 3);
      const GuardedBlock block(device, rows, columns, x);
      dropout(block.rows(), 0.75F, key);
      const MatrixF kept = MatrixF::NullaryExpr(rows, columns, [&](auto r, auto c) {
        const float u =
            random_uniform(key, static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(c));
        return u < 0.75F ? x(r, c) : 0.0F;
      });
      check_within(block.values(), divided(exact(kept), 0.75));
      CHECK(block.intact());
    }
    const Matrix ones = Matrix::from_host(device, MatrixF::Ones(200, 100));
    dropout(ones, 0.75F, key);
    // 20,000 draws: the mean's standard deviation is sqrt(1/3 / 20000) = 0.0041.
    CHECK(ones.to_host().mean() == doctest::Approx(1.0).epsilon(0.02));
    CHECK_THROWS_AS(dropout(ones, 0.0F, key), ShapeError);
  });
}

TEST_CASE("small: every entry times that of another matrix, and nothing beside them") {
  on_every_device([](Device& device) {
    for (const Size& size : kSmallSizes) {
      CAPTURE(size.rows);
      CAPTURE(size.columns);
      const auto rows = static_cast<Eigen::Index>(size.rows);
      const MatrixF x = random_matrix(size.rows + 3, size.columns, 1),
                    by = random_matrix(size.rows + 1, size.columns, 2);
      const Matrix out = Matrix::from_host(device, x);
      multiply(Rows(out, 2, size.rows), Rows(Matrix::from_host(device, by), 1, size.rows));
      MatrixF want = x;
      want.middleRows(2, rows).array() *= by.bottomRows(rows).array();
      CHECK(out.to_host() == want);  // one rounding each
      CHECK(padding_is_zero(out));
    }
  });
}

TEST_CASE("small: shapes that differ are refused") {
  on_every_device([](Device& device) {
    const Matrix x(device, 3, 5), y(device, 3, 6);
    Matrix out(device, 5, 4), sum(device, 1, 6);
    const IndexBuffer index(device, {0, 1});
    CHECK_THROWS_AS(scaled_difference(x, y, 1.0F, x), ShapeError);
    CHECK_THROWS_AS(scaled_difference(x, x, 1.0F, y), ShapeError);
    CHECK_THROWS_AS(multiply(x, y), ShapeError);
    CHECK_THROWS_AS(transpose(x, out), ShapeError);
    CHECK_THROWS_AS(column_sum(x, 1.0F, 0.0F, sum), ShapeError);
    CHECK_THROWS_AS(gather(x, x), ShapeError);
    CHECK_THROWS_AS(gather(Rows::indexed(x, index, 0, 2), x), ShapeError);
    CHECK_THROWS_AS(block_sum(Matrix(device, 7, 5), x), ShapeError);
  });
}

}  // namespace pointwise_test
