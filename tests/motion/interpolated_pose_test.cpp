// A pose between two.

#include "motion/interpolated_pose.hpp"

#include <doctest/doctest.h>

#include "motion/synthetic_motion.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

TEST_CASE("an interpolated pose: the short way round, positions straight, angles go on") {
  Skeleton skeleton;
  skeleton.joints = {
      make_joint("Root", -1, {0, 0, 0},
                 {x_position, y_position, z_position, z_rotation, x_rotation, y_rotation})};
  RowVectorD from(6), to(6), previous(6);
  from << 0, 1, 2, 350, 0, 0;
  to << 10, 1, -2, 30, 0, 0;
  previous << 0, 0, 0, 720 + 350, 0, 0;
  const RowVectorD quarter = interpolated_pose(skeleton, from, to, 0.25, previous);
  CHECK(quarter[0] == doctest::Approx(2.5));
  CHECK(quarter[2] == doctest::Approx(1));
  CHECK(quarter[3] == doctest::Approx(720 + 360));
  CHECK(quarter[4] == doctest::Approx(0));
  CHECK(interpolated_pose(skeleton, from, to, 0, from).isApprox(from));
  CHECK(interpolated_pose(skeleton, from, to, 1, previous)[3] == doctest::Approx(720 + 390));
}
