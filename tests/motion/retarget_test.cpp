#include "motion/retarget.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "mcdbn/base/errors.hpp"
#include "motion/body_size.hpp"
#include "motion/synthetic_motion.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

using enum JointRole;

/// Arms out to the sides in the rest pose, or hanging; names and joints differ, too.
Skeleton body(bool hanging, double scale) {
  const std::vector<Channel> zyx{z_rotation, y_rotation, x_rotation};
  Skeleton result;
  const auto add = [&](const std::string& name, int parent, Eigen::Vector3d offset) {
    result.joints.push_back(make_joint(name, parent, scale * offset, zyx));
    return result.joint_count() - 1;
  };
  if (hanging) add("World", -1, {0, 0, 0});
  const int hips = add(hanging ? "Pelvis" : "Hips", result.joint_count() - 1, {0, 0, 0});
  auto& channels = result.joints[hips].channels;
  channels.insert(channels.begin(), {x_position, y_position, z_position});
  const int chest = add(hanging ? "Torso" : "Spine", hips, {0, 30, 0});
  const int neck_joint = add("Neck", chest, {0, 20, 0});
  add("Head", neck_joint, {0, 12, 0});
  for (const double x : {1.0, -1.0}) {
    const std::string side = x > 0 ? "Left" : "Right";
    const Eigen::Vector3d down(0, -1, 0), out(x, 0, 0), arm = hanging ? down : out;
    int joint = add(side + (hanging ? "Thigh" : "UpLeg"), hips, {9 * x, -5, 0});
    joint = add(side + (hanging ? "Shin" : "Leg"), joint, 41 * down);
    joint = add(side + "Foot", joint, 42 * down);
    add(side + "Toe", joint, {0, -6, 14});
    joint = add(side + (hanging ? "UpperArm" : "Arm"), chest, {18 * x, 15, 0});
    joint = add(side + (hanging ? "LowerArm" : "ForeArm"), joint, 29 * arm);
    add(side + "Hand", joint, 25 * arm);
  }
  return result;
}

}  // namespace

TEST_CASE("retargeted: every role's joint is where it was, whatever the rest pose and the names") {
  const Motion motion = swinging(body(false, 1), 20);
  const SkeletonRoles roles = skeleton_roles(motion.skeleton);
  Skeleton target = body(true, 1);
  // Turned on the spot, too.
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitY()).toRotationMatrix();
  for (Joint& joint : target.joints) joint.offset = turn * joint.offset;
  const SkeletonRoles target_roles = skeleton_roles(target);
  const Motion result = retargeted(motion, roles, HumanoidRig({target, 0.1, {}}, target_roles));
  CHECK(result.frames() == 20);
  CHECK(result.fps() == doctest::Approx(motion.fps()));
  const MatrixD wanted = joint_positions(motion), got = joint_positions(result);
  for (const JointRole role : joint_roles()) {
    if (!roles.has(role)) continue;
    CAPTURE(std::string(name_of(role)));
    CHECK((wanted.middleCols<3>(3 * roles.joint(role)) -
           got.middleCols<3>(3 * target_roles.joint(role)))
              .cwiseAbs()
              .maxCoeff() < 1e-6);
  }
  Skeleton no_body;
  no_body.joints = {make_joint("Base", -1, {0, 0, 0}, {})};
  const HumanoidRig there({target, 0.1, {}}, target_roles);
  CHECK_THROWS_AS(retargeted({no_body, 0.1, {}}, skeleton_roles(no_body), there), InputError);
  // The humanoid's own motion needs no rig, whatever it lacks.
  const HumanoidRig rig(motion, roles);
  CHECK(retargeted(rig.to_humanoid(motion), {}, there).channels.isApprox(result.channels, 1e-6));
}

TEST_CASE("a skeleton takes on a person's height and limbs") {
  const Skeleton own = body(false, 1);
  Skeleton person = body(true, 0.01);
  person.joints[person.find("LeftLowerArm")].offset *= 1.5;
  const SkeletonRoles roles = skeleton_roles(own);
  const Skeleton taken = with_limbs_of(own, roles, person, skeleton_roles(person));
  CHECK(body_height(taken) == doctest::Approx(body_height(person)));
  CHECK(taken.joints[taken.find("LeftForeArm")].offset.norm() == doctest::Approx(0.29 * 1.5));
  CHECK(taken.joints[taken.find("RightForeArm")].offset.norm() == doctest::Approx(0.29));
  CHECK(taken.joints[taken.find("LeftForeArm")].offset.normalized().isApprox(
      Eigen::Vector3d::UnitX()));
  CHECK(taken.joints[taken.find("Spine")].offset.isApprox(Eigen::Vector3d(0, 0.3, 0)));
}
