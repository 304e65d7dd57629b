#include "features/pose_bones.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include "mcdbn/synthesis/synthesize.hpp"
#include "motion/body_size.hpp"

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
