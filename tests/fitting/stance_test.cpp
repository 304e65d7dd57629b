#include "fitting/stance.hpp"

#include <doctest/doctest.h>

#include "fitting/two_second_walk.hpp"

namespace stance_test {

using namespace mcdbn;
using namespace mcdbn::test;

TEST_CASE(
    "stance: upright is from the feet to the body's middle, whatever stands still above the root") {
  const Motion walk = two_second_walk();
  Camera level;  // of the world's axes
  const Eigen::Vector3d up = stance_in_camera(walk, level).upright;
  CHECK(up.normalized().y() > 0.95);
  Motion hung = walk;
  for (Joint& joint : hung.skeleton.joints) ++joint.parent;
  Joint still;
  still.name = "joint_Root";
  still.parent = -1;
  hung.skeleton.joints.insert(hung.skeleton.joints.begin(), still);
  CHECK((stance_in_camera(hung, level).upright - up).norm() < 1e-9);
}

TEST_CASE("stance: legs are bent by what their ends are nearer than a straight leg has them") {
  Motion motion;
  motion.frame_time_s = 0.1;
  const auto joint = [&](const char* name, int parent, const Eigen::Vector3d& offset) {
    Joint made;
    made.name = name;
    made.parent = parent;
    made.offset = offset;
    if (parent < 0) made.channels = {Channel::x_position, Channel::y_position, Channel::z_position};
    made.channels.push_back(Channel::x_rotation);
    motion.skeleton.joints.push_back(made);
  };
  joint("hips", -1, {0, 100, 0});
  joint("thigh", 0, {10, 0, 0});
  joint("shank", 1, {0, -40, 0});
  joint("ankle", 2, {0, -30, 0});
  joint("toes", 3, {0, 0, 10});
  motion.channels = MatrixD::Zero(2, 8);
  const Camera level;
  CHECK(stance_in_camera(motion, level).bent_legs == doctest::Approx(0));
  // Knees at a right angle in one frame of two: 40 and 30 make 50 of 70.
  motion.channels(1, 5) = 90;
  CHECK(stance_in_camera(motion, level).bent_legs == doctest::Approx(0.5 * (1 - 50.0 / 70)));
  motion.skeleton.joints[3].name = "end";
  motion.skeleton.joints[4].name = "tip";
  CHECK(stance_in_camera(motion, level).bent_legs == 0);
}

TEST_CASE("stance: the mean of two means counts their frames") {
  const Stance mean = mean_stance({{1, 0, 0}, 0.2}, 3, {{0, 2, 0}, 0.6}, 1);
  CHECK((mean.upright - Eigen::Vector3d(0.75, 0.5, 0)).norm() < 1e-12);
  CHECK(mean.bent_legs == doctest::Approx(0.3));
  CHECK(mean_stance({}, 0, {{0, 2, 0}, 0.6}, 5).bent_legs == doctest::Approx(0.6));
  CHECK(mean_stance({}, 0, {}, 0).upright == Eigen::Vector3d::Zero());
}

}  // namespace stance_test
