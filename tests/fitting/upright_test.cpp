#include "fitting/upright.hpp"

#include <doctest/doctest.h>

#include "fitting/two_second_walk.hpp"

namespace upright_test {

using namespace mcdbn;
using namespace mcdbn::test;

TEST_CASE("upright: from the feet to the body's middle, whatever stands still above the root") {
  const Motion walk = two_second_walk();
  Camera level;  // of the world's axes
  const Eigen::Vector3d up = upright_in_camera(walk, level);
  CHECK(up.normalized().y() > 0.95);
  Motion hung = walk;
  for (Joint& joint : hung.skeleton.joints) ++joint.parent;
  Joint still;
  still.name = "joint_Root";
  still.parent = -1;
  hung.skeleton.joints.insert(hung.skeleton.joints.begin(), still);
  CHECK((upright_in_camera(hung, level) - up).norm() < 1e-9);
}

}  // namespace upright_test
