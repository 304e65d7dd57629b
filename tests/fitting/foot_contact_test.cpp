// Which joints are feet.

#include <doctest/doctest.h>

#include "motion/foot_joints.hpp"
#include "motion/synthetic_motion.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

TEST_CASE("feet are the joints with a foot, a toe or an ankle in their names") {
  Skeleton skeleton;
  for (const char* name : {"Hips", "LeftFoot", "rtoebase", "L_ANKLE", "LeftLeg", "Toe_End_R",
                           "forefoot", "Hand", "Football"})
    skeleton.joints.push_back(make_joint(name, skeleton.joint_count() - 1, {0, 1, 0}, {}));
  CHECK(foot_joints(skeleton) == std::vector<int>{1, 2, 3, 5, 6, 8});
  CHECK(foot_joints(Skeleton{}).empty());
}
