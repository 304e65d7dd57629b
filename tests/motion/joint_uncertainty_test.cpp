// Joints' uncertainty, from drawn motions.

#include "motion/joint_uncertainty.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "mcdbn/base/errors.hpp"

namespace joint_uncertainty_test {

using namespace mcdbn;

namespace {

/// A root that moves and turns about z, and a bone of that length to its right.
Motion bone(double length, double root_x, double turn_deg) {
  Motion motion;
  motion.skeleton.joints = {
      {"Root",
       -1,
       {0, 0, 0},
       {Channel::x_position, Channel::y_position, Channel::z_position, Channel::z_rotation},
       {}},
      {"Hand", 0, {length, 0, 0}, {}, {}}};
  motion.channels.resize(2, 4);
  motion.channels << root_x, 0, 0, 0, root_x, 0, 0, turn_deg;
  return motion;
}

}  // namespace

TEST_CASE("joint uncertainty: the root's in the world, the others' from the root") {
  const MatrixD found =
      joint_uncertainty(bone(2, 5, 90), {bone(2, 8, 90), bone(2, 1, 90), bone(4, 5, 0)});
  REQUIRE(found.rows() == 2);
  REQUIRE(found.cols() == 6);
  // 3 right, 4 left and where it is.
  CHECK(found(0, 0) == doctest::Approx(std::sqrt((9 + 16 + 0) / 3.0)));
  CHECK(found(1, 0) == doctest::Approx(std::sqrt((9 + 16 + 0) / 3.0)));
  // From the root nothing differs but the third: at first by its length, then by its direction.
  CHECK(found(0, 3) == doctest::Approx(std::sqrt(4 / 3.0)));
  CHECK(found(0, 4) == doctest::Approx(0));
  CHECK(found(1, 3) == doctest::Approx(std::sqrt(16 / 3.0)));
  CHECK(found(1, 4) == doctest::Approx(std::sqrt(4 / 3.0)));
  CHECK(found.col(5).isZero());
}

TEST_CASE("joint uncertainty: from another joint than the first") {
  const MatrixD found = joint_uncertainty(bone(2, 5, 90), {bone(2, 8, 90), bone(4, 5, 90)}, 1);
  // The hand where it is, at first 2 right of the root, and so the root above it.
  CHECK(found(0, 3) == doctest::Approx(std::sqrt((9 + 4) / 2.0)));
  CHECK(found(0, 0) == doctest::Approx(std::sqrt(9 / 2.0)));
  CHECK(found(1, 1) == doctest::Approx(0));
}

TEST_CASE("joint uncertainty: without draws nothing, and draws of the clip's shape") {
  CHECK(joint_uncertainty(bone(2, 5, 90), {}).isZero());
  Motion shorter = bone(2, 5, 90);
  shorter.channels.conservativeResize(1, Eigen::NoChange);
  CHECK_THROWS_AS(joint_uncertainty(bone(2, 5, 90), {shorter}), ShapeError);
}

}  // namespace joint_uncertainty_test
