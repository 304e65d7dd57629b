#include "features/pose_bones.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include "mcdbn/synthesis/synthesize.hpp"
#include "motion/body_size.hpp"
#include "motion/synthetic_motion.hpp"

using namespace mcdbn;

TEST_CASE("turned levers add up to where forward kinematics puts the joints") {
  SynthesisOptions options;
  options.seconds = 1.0;
  const Motion motion = synthesize(options);
  const PoseFeatures features = PoseFeatures::fit({&motion});
  const auto bones = pose_bones(features);
  const MatrixD encoded = features.encode(motion, Eigen::Matrix3d::Identity());
  const double metres = 1.0 / file_units_per_metre(motion.skeleton);
  for (const int frame : {0, 13, 29}) {
    const WorldPose pose = forward_kinematics(motion.skeleton, motion.channels.row(frame));
    // Positions of all joints, to be found again whatever the order.
    std::vector<Eigen::Vector3d> positions;
    for (std::size_t i = 0; i < bones.size(); ++i) {
      Eigen::Matrix3d turn;
      turn.col(0) = encoded.row(frame).segment<3>(6 * bones[i].block).transpose();
      turn.col(1) = encoded.row(frame).segment<3>(6 * bones[i].block + 3).transpose();
      turn.col(2) = turn.col(0).cross(turn.col(1));
      const Eigen::Vector3d start =
          bones[i].parent < 0 ? Eigen::Vector3d::Zero() : positions[bones[i].parent];
      CHECK(bones[i].parent < static_cast<int>(i));
      positions.emplace_back(start + turn * bones[i].lever_m);
    }
    for (int j = 0; j < motion.skeleton.joint_count(); ++j) {
      const Joint& joint = motion.skeleton.joints[j];
      if (j == features.root() || joint.offset.norm() == 0) continue;
      const Eigen::Vector3d want = metres * (pose.position[j] - pose.position[features.root()]);
      double nearest = 1.0;
      for (const Eigen::Vector3d& position : positions)
        nearest = std::min(nearest, (position - want).norm());
      CAPTURE(joint.name);
      CHECK(nearest < 1e-9);
    }
  }
}

TEST_CASE("what stands above the root is no bone, also where joint 0 turns and travels") {
  Motion motion = test::swinging(test::small_body_below_still_root(), 20);
  // A joint between the two, and a scene that turns.
  Skeleton& skeleton = motion.skeleton;
  for (Joint& joint : skeleton.joints)
    if (joint.parent >= 0) ++joint.parent;
  skeleton.joints.insert(skeleton.joints.begin() + 1,
                         test::make_joint("Reference", 0, {50, 0, 20}, {}));
  skeleton.joints[2].parent = 1;
  for (int t = 0; t < 20; ++t) {
    motion.channels(t, 0) = 2.0 * t;
    motion.channels(t, skeleton.first_channel(0) + 5) = 3.0 * t;
  }
  const PoseFeatures features = PoseFeatures::fit({&motion});
  REQUIRE(features.root() == skeleton.find("Hips"));
  REQUIRE(features.joints().front() == 0);
  const auto bones = pose_bones(features);
  CHECK(!bones.empty());
  for (const PoseBone& bone : bones) CHECK(bone.joint > features.root());
}
