#include "mcdbn/device/matrix.hpp"

#include <doctest/doctest.h>

#include "device/every_device.hpp"
#include "mcdbn/base/errors.hpp"

namespace matrix_test {

using namespace mcdbn;
using namespace mcdbn::test;

TEST_CASE("small: a matrix comes back as it went, with zeros as padding") {
  on_every_device([](Device& device) {
    for (const auto& [rows, columns] :
         {std::pair<std::size_t, std::size_t>{1, 1}, {3, 15}, {7, 16}, {5, 17}}) {
      const MatrixF values = random_matrix(rows, columns, 1);
      const Matrix matrix = Matrix::from_host(device, values);
      CHECK(matrix.stride() % kColumnPad == 0);
      CHECK(matrix.to_host() == values);
      CHECK(padding_is_zero(matrix));
      Matrix copy(device, rows, columns);
      CHECK(copy.to_host().isZero(0.0F));
      copy.copy_from(matrix);
      CHECK(read_padded(copy) == read_padded(matrix));
      copy.set_zero();
      CHECK(read_padded(copy).isZero(0.0F));
    }
  });
}

TEST_CASE("small: matrices without rows or columns hold nothing") {
  on_every_device([](Device& device) {
    for (const auto& [rows, columns] : {std::pair<std::size_t, std::size_t>{0, 5}, {5, 0}}) {
      Matrix matrix(device, rows, columns);
      CHECK(matrix.empty());
      CHECK(matrix.to_host().rows() == static_cast<Eigen::Index>(rows));
      CHECK(matrix.to_host().cols() == static_cast<Eigen::Index>(columns));
      CHECK_NOTHROW(matrix.set_zero());
    }
  });
}

TEST_CASE("small: a matrix takes only values of its shape, and refuses to pass 32-bit offsets") {
  on_every_device([](Device& device) {
    Matrix matrix(device, 3, 5);
    CHECK_THROWS_AS(matrix.upload(MatrixF::Zero(5, 3)), ShapeError);
    CHECK_THROWS_AS(matrix.copy_from(Matrix(device, 5, 3)), ShapeError);
    CHECK_THROWS_AS(Matrix(device, 1U << 20, 1U << 12), DeviceError);
    IndexBuffer index(device, {1, 2, 3});
    CHECK_THROWS_AS(index.upload(device, {1, 2}), ShapeError);
  });
}

TEST_CASE("small: a matrix is filled with one row, and not with two or none") {
  on_every_device([](Device& device) {
    const MatrixF row = random_matrix(1, 5, 1);
    const Matrix filled = Matrix::filled_with_row(Matrix::from_host(device, row), 3);
    CHECK(filled.to_host() == row.replicate(3, 1));
    CHECK_THROWS_AS(Matrix::filled_with_row(Matrix(device, 2, 5), 3), ShapeError);
    CHECK_THROWS_AS(Matrix::filled_with_row(Matrix(device, 0, 5), 3), ShapeError);
  });
}

}  // namespace matrix_test
