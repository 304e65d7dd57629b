// Which joints are feet, and what standing feet say of the root's velocity: by hand.

#include <doctest/doctest.h>

#include <cmath>

#include "fitting/planted_velocity.hpp"
#include "motion/foot_joints.hpp"
#include "motion/synthetic_motion.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr double kFps = 25;
/// What the code under test takes for low and slow (kPlantedInAnswer), and what a given velocity
/// weighs.
constexpr double kLow_m = 0.05, kSlow_m_s = 0.4, kGivenWeight = 0.1;

/// A root below the world and two feet that go where their channels say, a body of 170 units.
Motion feet_alone() {
  Motion motion;
  const std::vector<Channel> shift{x_position, y_position, z_position};
  motion.skeleton.joints = {make_joint("World", -1, {0, 0, 0}, {}),
                            make_joint("Hips", 0, {0, 0, 0}, shift),
                            make_joint("LeftFoot", 0, {10, -170, 0}, shift),
                            make_joint("RightFoot", 0, {-10, -170, 0}, shift)};
  motion.frame_time_s = 1 / kFps;
  motion.channels.resize(4, 9);
  motion.channels << 0, 90, 0, 10, 5, 0, -10, 6, 0,  //
      1, 91, 5, 10.2, 4, 0.5, -10, 9, 3,             //
      3, 89, 11, 10.3, 4.5, 0.6, -11, 12, 9,         //
      4, 90, 16, 11, 8, 5, -11.1, 11, 9.3;
  return motion;
}

/// sum of the weighed velocities over the sum of the weights, in units a second
Eigen::RowVector3d wanted(const Motion& motion, int frame, const Eigen::RowVector3d& given) {
  const auto at = [&](int f, int block) -> Eigen::RowVector3d {
    return motion.channels.row(f).segment<3>(3 * block);
  };
  const auto height = [&](int block) {
    return std::max(at(frame, block).y(), at(frame - 1, block).y());
  };
  const double lowest = std::min(height(1), height(2));
  Eigen::RowVector3d sum = kGivenWeight * given;
  double total = kGivenWeight;
  for (const int foot : {1, 2}) {
    const Eigen::RowVector3d moved = (at(frame, foot) - at(frame - 1, foot)) * kFps;
    const double high = (height(foot) - lowest) / 100 / kLow_m,
                 fast = moved.norm() / 100 / kSlow_m_s;
    const double weight = std::exp(-(high * high + fast * fast) / 2);
    sum += weight * ((at(frame, 0) - at(frame - 1, 0)) * kFps - moved);
    total += weight;
  }
  return sum / total;
}

}  // namespace

TEST_CASE("a root's velocity is the mean of what its feet say, as surely as each stands") {
  const Motion motion = feet_alone();
  MatrixD given(4, 3);
  given << 1, 2, 3, 40, -5, 60, 70, 8, -90, 10, 11, 120;
  const MatrixD told = planted_velocity(motion, 1, {2, 3}, given);
  REQUIRE(told.rows() == 4);
  for (int frame = 1; frame < 4; ++frame) {
    CAPTURE(frame);
    CHECK((told.row(frame) - wanted(motion, frame, given.row(frame))).norm() < 1e-10);
  }
  CHECK(told.row(0) == told.row(1));
}

TEST_CASE("feet are the joints with a foot, a toe or an ankle in their names") {
  Skeleton skeleton;
  for (const char* name : {"Hips", "LeftFoot", "rtoebase", "L_ANKLE", "LeftLeg", "Toe_End_R",
                           "forefoot", "Hand", "Football"})
    skeleton.joints.push_back(make_joint(name, skeleton.joint_count() - 1, {0, 1, 0}, {}));
  CHECK(foot_joints(skeleton) == std::vector<int>{1, 2, 3, 5, 6, 8});
  CHECK(foot_joints(Skeleton{}).empty());
}
