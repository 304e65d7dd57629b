#include "motion/humanoid_poses.hpp"

#include <doctest/doctest.h>

#include "mcdbn/base/errors.hpp"
#include "motion/humanoid_motion.hpp"
#include "motion/synthetic_motion.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

TEST_CASE("humanoid poses: as they were, and turned in the world") {
  using enum JointRole;
  const Motion motion = moving_humanoid(20);
  HumanoidPoses poses(motion);
  CHECK(largest_difference(poses.motion(), motion) < 1e-9);
  const WorldPose pose = forward_kinematics(motion.skeleton, motion.channels.row(7));
  for (const JointRole role : joint_roles())
    CHECK(poses.world(7, role).isApprox(pose.world_from_joint[humanoid_roles().joint(role)]));
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const Eigen::Matrix3d head_was = poses.local(7, head);
  for (const JointRole role : {chest, pelvis}) {
    poses.set_world(7, role, turn);
    CHECK(poses.world(7, role).isApprox(turn));
  }
  CHECK(poses.local(7, head) == head_was);
  const MatrixD positions = joint_positions(motion);
  double lowest = 1e9;
  for (const JointRole role : {left_ankle, left_toe, right_ankle, right_toe})
    lowest = std::min(lowest, positions(3, 3 * humanoid_roles().joint(role) + 1));
  CHECK(poses.lowest_foot()[3] == doctest::Approx(lowest));
  CHECK_THROWS_AS(HumanoidPoses(swinging(small_body(), 3)), ShapeError);
}

TEST_CASE("humanoid poses: what hangs on what") {
  using enum JointRole;
  CHECK(is_below(left_hand, left_clavicle));
  CHECK(is_below(left_clavicle, left_clavicle));
  CHECK(is_below(left_clavicle, chest));
  CHECK_FALSE(is_below(left_hip, chest));
  CHECK_FALSE(is_below(right_hand, left_clavicle));
  CHECK(role_above(left_hip) == pelvis);
  CHECK(role_above(pelvis) == pelvis);
}
