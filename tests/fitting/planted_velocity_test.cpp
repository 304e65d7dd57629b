#include "fitting/planted_velocity.hpp"

#include <doctest/doctest.h>

#include "mcdbn/base/errors.hpp"
#include "mcdbn/synthesis/synthesize.hpp"

using namespace mcdbn;

namespace {

MatrixD velocity_of(const MatrixD& path, double fps) {
  MatrixD velocity = MatrixD::Zero(path.rows(), 3);
  const Eigen::Index steps = path.rows() - 1;
  velocity.bottomRows(steps) = (path.bottomRows(steps) - path.topRows(steps)) * fps;
  velocity.row(0) = velocity.row(1);
  return velocity;
}

}  // namespace

TEST_CASE("planted feet tell how fast a walk goes, whatever velocity was given") {
  const Motion walk = synthesize({.seconds = 4});
  std::vector<int> feet;
  for (const char* name : {"LeftFoot", "RightFoot", "LeftToeBase", "RightToeBase"}) {
    feet.push_back(walk.skeleton.find(name));
    REQUIRE(feet.back() >= 0);
  }
  const MatrixD truth = velocity_of(joint_positions(walk).leftCols<3>(), walk.fps());
  const MatrixD wrong = 1.3 * truth;
  const MatrixD told = planted_velocity(walk, 0, feet, wrong);
  // One foot at least always stands, by Winter's gait; a given velocity weighs a tenth of a foot.
  CHECK((told - truth).norm() < 0.3 * (wrong - truth).norm());
  CHECK(planted_velocity(walk, 0, {}, wrong) == wrong);
}

TEST_CASE("feet in flight tell nothing of the root's velocity") {
  Motion walk = synthesize({.seconds = 1});
  // Carried along at 5 m/s: no foot is slow.
  for (int frame = 0; frame < walk.frames(); ++frame) {
    walk.channels(frame, 0) += 500.0 * frame / walk.fps();
  }
  const MatrixD given = MatrixD::Constant(walk.frames(), 3, 123);
  const std::vector<int> feet{walk.skeleton.find("LeftFoot"), walk.skeleton.find("RightFoot")};
  CHECK((planted_velocity(walk, 0, feet, given) - given).norm() < 1e-6 * given.norm());
  CHECK_THROWS_AS(planted_velocity(walk, 0, feet, given.topRows(3)), ShapeError);
  walk.channels.conservativeResize(1, Eigen::NoChange);
  CHECK(planted_velocity(walk, 0, feet, given.topRows(1)) == given.topRows(1));
}
