#include "mcdbn/device/parameters.hpp"

#include <doctest/doctest.h>

#include "device/every_device.hpp"
#include "mcdbn/base/errors.hpp"

namespace parameters_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// A history of two frames of three units among them, and one matrix without rows.
const std::vector<ParameterShape> kShapes{
    {.name = "pose.W", .rows = 3, .columns = 17},
    {.name = "pose.A", .rows = 6, .columns = 5, .frame_rows = 3},
    {.name = "pose.none", .rows = 0, .columns = 5},
    {.name = "track.b", .rows = 1, .columns = 33, .is_weight = false}};

MatrixF values_of(const ParameterShape& shape, unsigned seed) {
  return random_matrix(shape.rows, shape.columns, seed);
}

void fill(Parameters& parameters, unsigned seed) {
  for (const Parameters::Entry& entry : parameters.entries())
    parameters.upload(entry.name, values_of(entry, seed++));
}

void check_filled(const Parameters& parameters, unsigned seed) {
  for (const Parameters::Entry& entry : parameters.entries()) {
    CAPTURE(entry.name);
    CHECK(parameters.to_host(entry.name) == values_of(entry, seed++));
  }
}

}  // namespace

TEST_CASE("small: every parameter keeps its own values in the one buffer") {
  on_every_device([](Device& device) {
    Parameters parameters(device, kShapes);
    REQUIRE(parameters.entries().size() == kShapes.size());
    for (const Parameters::Entry& entry : parameters.entries())
      CHECK((parameters.to_host(entry.name).array() == 0).all());
    fill(parameters, 1);
    check_filled(parameters, 1);
    std::size_t end = 0;
    for (const Parameters::Entry& entry : parameters.entries()) {
      CHECK(entry.first >= end);
      end = entry.first + entry.floats();
    }
    CHECK(end <= parameters.all().columns());
  });
}

TEST_CASE("small: the frames of a history are padded as rows of a matrix are") {
  on_every_device([](Device& device) {
    Parameters parameters(device, kShapes);
    fill(parameters, 1);
    const Matrix A = parameters.matrix("pose.A");
    REQUIRE(A.rows() == 2 * padded(3));
    MatrixF want = MatrixF::Zero(2 * padded(3), 5);
    want.middleRows(0, 3) = values_of(kShapes[1], 2).topRows(3);
    want.middleRows(padded(3), 3) = values_of(kShapes[1], 2).bottomRows(3);
    CHECK(A.to_host() == want);
    CHECK(padding_is_zero(A));
  });
}

TEST_CASE("small: a matrix, a part and a copy are in place") {
  on_every_device([](Device& device) {
    Parameters parameters(device, kShapes);
    fill(parameters, 1);
    const Parameters copy = parameters;
    const MatrixF other = random_matrix(3, 17, 9);
    parameters.matrix("pose.W").upload(other);
    CHECK(copy.to_host("pose.W") == other);
    const Parameters pose = parameters.part("pose.");
    REQUIRE(pose.entries().size() == 3);
    CHECK(pose.to_host("W") == other);
    CHECK(pose.to_host("A") == values_of(kShapes[1], 2));
    CHECK_THROWS_AS(pose.matrix("b"), ShapeError);
    CHECK(pose.all().buffer()() == parameters.all().buffer()());
  });
}

TEST_CASE("small: the same entries in another buffer leave the first alone") {
  on_every_device([](Device& device) {
    Parameters parameters(device, kShapes);
    fill(parameters, 1);
    Parameters gradients = parameters.in(Matrix::like(parameters.all()));
    fill(gradients, 11);
    check_filled(parameters, 1);
    check_filled(gradients, 11);
    parameters.copy_from(gradients.all());
    check_filled(parameters, 11);
    CHECK_THROWS_AS(parameters.in(Matrix(device, 1, 16)), ShapeError);
  });
}

TEST_CASE("small: parameters refuse what does not fit") {
  on_every_device([](Device& device) {
    CHECK_THROWS_AS(Parameters(device, {{.name = "W", .rows = 1, .columns = 1},
                                        {.name = "W", .rows = 2, .columns = 1}}),
                    ShapeError);
    Parameters parameters(device, kShapes);
    CHECK_THROWS_AS(parameters.upload("pose.W", MatrixF::Zero(17, 3)), ShapeError);
    CHECK_THROWS_AS(parameters.upload("pose.V", MatrixF::Zero(1, 1)), ShapeError);
    CHECK_THROWS_AS(parameters.entry("W"), ShapeError);
    CHECK_THROWS_AS(parameters.all().part(parameters.all().columns(), 1, 16), ShapeError);
  });
}

}  // namespace parameters_test
