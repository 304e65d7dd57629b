// Features of several clips and bodies: what is averaged, in which unit, at which rate.

#include <doctest/doctest.h>

#include <vector>

#include "mcdbn/camera/camera.hpp"
#include "mcdbn/features/pose_features.hpp"
#include "motion/synthetic_motion.hpp"

using namespace mcdbn;
using test::small_body;
using test::small_body_below_still_root;
using test::swinging;

namespace {

const Eigen::Matrix3d kBodiesCamera = camera_rotation(-70, 25);

Motion scaled(Motion motion, double scale) {
  int column = 0;
  for (Joint& joint : motion.skeleton.joints) {
    joint.offset *= scale;
    for (Eigen::Vector3d& end : joint.end_sites) end *= scale;
    for (const Channel channel : joint.channels) {
      if (!is_rotation(channel)) motion.channels.col(column) *= scale;
      ++column;
    }
  }
  return motion;
}

}  // namespace

TEST_CASE(
    "pose features: a body's unit and size change nothing, the rate only the velocity's frames") {
  const Motion motion = swinging(small_body(), 40, 50);
  const PoseFeatures features = PoseFeatures::fit({&motion});
  const MatrixD want = features.encode(motion, kBodiesCamera);
  // Each clip is measured by its own body, not by the first one's.
  CHECK((features.encode(scaled(motion, 0.01), kBodiesCamera) - want).cwiseAbs().maxCoeff() < 1e-9);
  CHECK((features.encode(scaled(motion, 3), kBodiesCamera) - want).cwiseAbs().maxCoeff() < 1e-9);
  Motion fast = motion;
  fast.frame_time_s /= 4;
  const MatrixD faster = features.encode(fast, kBodiesCamera);
  const Eigen::Index velocity = features.velocity_feature();
  CHECK(faster.leftCols(velocity) == want.leftCols(velocity));
  CHECK((faster.rightCols<3>() - 4 * want.rightCols<3>()).cwiseAbs().maxCoeff() < 1e-9);
  CHECK(want.rightCols<3>().cwiseAbs().maxCoeff() > 0.1);
}

TEST_CASE("pose features: decoded clips have the rate, the body and the root's path given") {
  const Motion motion = swinging(small_body(), 25, 50);
  const PoseFeatures features = PoseFeatures::fit({&motion});
  MatrixD root(25, 3);
  for (int t = 0; t < 25; ++t) root.row(t) << 5 * t, 80 - t, -3 * t + 7;
  const Motion decoded = features.decode(features.encode(motion, kBodiesCamera), kBodiesCamera,
                                         motion.skeleton, 24, root);
  CHECK(decoded.fps() == doctest::Approx(24));
  CHECK((joint_positions(decoded).leftCols<3>() - root).cwiseAbs().maxCoeff() < 1e-9);
  CHECK((decoded.channels.rightCols(decoded.channels.cols() - 6) -
         motion.channels.rightCols(motion.channels.cols() - 6))
            .cwiseAbs()
            .maxCoeff() < 1e-7);
}

TEST_CASE("pose features: position channels of all frames of all clips make the mean one") {
  const Motion first = swinging(small_body_below_still_root(), 10);
  Motion second = swinging(small_body_below_still_root(), 40);
  // Another body, whose joints stray from their own OFFSETs by another length.
  const int joint = first.skeleton.find("LShin"), column = first.skeleton.first_channel(joint);
  second.skeleton.joints[joint].offset += Eigen::Vector3d(1, -2, 4);
  for (int axis = 0; axis < 3; ++axis)
    second.channels.col(column + axis)
        .setConstant(second.skeleton.joints[joint].offset[axis] + 0.3 + 0.5 * (axis + 1));
  const PoseFeatures features = PoseFeatures::fit({&first, &second});
  for (int axis = 0; axis < 3; ++axis) {
    const double want = first.skeleton.joints[joint].offset[axis] + 0.3 + 0.8 * 0.5 * (axis + 1);
    CHECK(std::abs(features.fixed_channels()[column + axis] - want) < 1e-9);
  }
  // The other way round the second's skeleton is the one, and the share the same.
  const PoseFeatures swapped = PoseFeatures::fit({&second, &first});
  CHECK(std::abs(swapped.fixed_channels()[column] -
                 (second.skeleton.joints[joint].offset[0] + 0.3 + 0.8 * 0.5)) < 1e-9);
}

TEST_CASE("pose features: a joint above the root that travels in one clip takes no clip's path") {
  const Motion usual = swinging(small_body_below_still_root(), 30);
  // The same path of the hips, as Bandai has it in four clips: what goes ahead is the joint above.
  Motion above = usual;
  const int world = usual.skeleton.first_channel(0),
            hips = usual.skeleton.first_channel(usual.skeleton.find("Hips"));
  above.channels.col(world + 2) = usual.channels.col(hips + 2);
  above.channels.col(hips + 2).setZero();
  REQUIRE(joint_positions(above).rightCols(42).isApprox(joint_positions(usual).rightCols(42)));
  const PoseFeatures features = PoseFeatures::fit({&usual, &above});
  CHECK(features.skeleton().joints[features.root()].name == "Hips");
  const MatrixD want = features.encode(usual, kBodiesCamera);
  CHECK(want.rightCols<3>().cwiseAbs().maxCoeff() > 0.1);
  for (const Motion* clip : std::vector<const Motion*>{&usual, &above}) {
    CHECK((features.encode(*clip, kBodiesCamera) - want).cwiseAbs().maxCoeff() < 1e-9);
    const MatrixD places = joint_positions(*clip);
    const Motion back =
        features.decode(want, kBodiesCamera, clip->skeleton, clip->fps(),
                        places.middleCols<3>(3 * static_cast<Eigen::Index>(features.root())));
    // Of the body; the joint above it stays where it was on average.
    CHECK((joint_positions(back) - places).rightCols(42).cwiseAbs().maxCoeff() < 1e-9);
    CHECK(back.channels.col(world + 2).maxCoeff() == back.channels.col(world + 2).minCoeff());
  }
}
