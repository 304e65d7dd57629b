#include "motion/turned_motion.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include "mcdbn/base/errors.hpp"
#include "motion/synthetic_motion.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

TEST_CASE("turned motion: every joint is where the turn takes it, in every frame") {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(2.1, Eigen::Vector3d(0.2, -0.9, 0.4).normalized()).toRotationMatrix();
  const Motion motion = swinging(small_body(), 40);
  const Motion turned = turned_motion(motion, turn);
  const MatrixD before = joint_positions(motion), after = joint_positions(turned);
  for (Eigen::Index joint = 0; joint < before.cols(); joint += 3)
    CHECK((after.middleCols(joint, 3) - before.middleCols(joint, 3) * turn.transpose())
              .cwiseAbs()
              .maxCoeff() < 1e-9);
  // Its own joints do not know of it.
  const int own = motion.skeleton.first_channel(1);
  CHECK(turned.channels.rightCols(turned.channels.cols() - own) ==
        motion.channels.rightCols(motion.channels.cols() - own));
  CHECK(turned.frame_time_s == motion.frame_time_s);
}

TEST_CASE("turned motion: angles run on without jumps") {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(3.0, Eigen::Vector3d::UnitY()).toRotationMatrix();
  // Turns by 500 degrees on its way.
  const Motion turned = turned_motion(swinging(small_body(), 200), turn);
  const MatrixD steps = turned.channels.bottomRows(199) - turned.channels.topRows(199);
  for (int k = 0; k < 6; ++k)
    if (is_rotation(turned.skeleton.joints[0].channels[static_cast<std::size_t>(k)]))
      CHECK(steps.col(k).cwiseAbs().maxCoeff() < 90);
}

TEST_CASE("turned motion: a root that cannot turn is an error") {
  Motion motion = swinging(small_body(), 2);
  motion.skeleton.joints[0].channels = {x_position, y_position, z_position};
  CHECK_THROWS_AS(turned_motion(motion, Eigen::Matrix3d::Identity()), ShapeError);
}
