#include "mcdbn/features/pose_features.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "base/capture_bound.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/camera/camera.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "motion/body_size.hpp"
#include "motion/synthetic_motion.hpp"
#include "shared_data.hpp"

using namespace mcdbn;
using test::make_joint;
using test::small_body;
using test::small_body_below_still_root;
using test::swinging;

namespace {

const Eigen::Matrix3d kCamera = camera_rotation(30, 10);

/// World positions of one joint. [frames x 3]
MatrixD positions_of(const Motion& motion, const std::string& name) {
  return joint_positions(motion).middleCols(3 * motion.skeleton.find(name), 3);
}

MatrixD root_positions(const PoseFeatures& features, const Motion& motion) {
  return positions_of(motion, features.skeleton().joints[features.root()].name);
}

Motion there_and_back(const PoseFeatures& features, const Motion& motion) {
  return features.decode(features.encode(motion, kCamera), kCamera, motion.skeleton, motion.fps(),
                         root_positions(features, motion));
}

double largest_difference(const MatrixD& a, const MatrixD& b) {
  REQUIRE(a.rows() == b.rows());
  REQUIRE(a.cols() == b.cols());
  return (a - b).cwiseAbs().maxCoeff();
}

/// The same skeleton, its joints stored child by child in another order, each with its rotation
/// channels reversed.
Skeleton reordered(const Skeleton& skeleton) {
  std::vector<int> order;
  const auto visit = [&](const auto& self, int joint) -> void {
    order.push_back(joint);
    for (int child = skeleton.joint_count() - 1; child > joint; --child) {
      if (skeleton.joints[child].parent == joint) self(self, child);
    }
  };
  visit(visit, 0);
  Skeleton result;
  for (const int j : order) {
    Joint joint = skeleton.joints[j];
    joint.parent =
        joint.parent < 0
            ? -1
            : static_cast<int>(std::find(order.begin(), order.end(), joint.parent) - order.begin());
    std::reverse(joint.channels.begin(), joint.channels.end());
    result.joints.push_back(joint);
  }
  return result;
}

}  // namespace

TEST_CASE("pose features: encode, then decode, gives every joint's position back") {
  for (const Skeleton& skeleton : {small_body(), small_body_below_still_root()}) {
    const Motion motion = swinging(skeleton, 90);
    const PoseFeatures features = PoseFeatures::fit({&motion});
    CHECK(features.skeleton().joints[features.root()].name == "Hips");
    CHECK(features.encode(motion, kCamera).cols() == features.dimension());
    const Motion back = there_and_back(features, motion);
    CHECK(back.fps() == doctest::Approx(30));
    CHECK(largest_difference(joint_positions(motion), joint_positions(back)) < 1e-9);
    // Angles run on through more than a whole turn of the root.
    const MatrixD steps = back.channels.bottomRows(89) - back.channels.topRows(89);
    CHECK(steps.cwiseAbs().maxCoeff() < 90);
  }
}

TEST_CASE("pose features: only joints that turn carry features, the others come back exactly") {
  const Motion motion = swinging(small_body(), 40, 30, {"Neck", "LHand", "LLeg"});
  const PoseFeatures features = PoseFeatures::fit({&motion});
  // 14 joints, three of them still and Chest without channels.
  CHECK(features.dimension() == 6 * 10 + 4);
  const std::vector<std::string> names = features.feature_names();
  CHECK(static_cast<int>(names.size()) == features.dimension());
  CHECK(names.front() == "Hips_x_axis_x");
  CHECK(names.back() == "root_velocity_z_m_s");
  CHECK(std::none_of(names.begin(), names.end(),
                     [](const std::string& name) { return name.starts_with("Neck"); }));
  const Motion back = there_and_back(features, motion);
  for (const char* still : {"Neck", "LHand", "LLeg"}) {
    const int joint = motion.skeleton.find(still);
    const int first = motion.skeleton.first_channel(joint);
    CHECK(back.channels.middleCols(first, 3) == motion.channels.middleCols(first, 3));
  }
  CHECK(largest_difference(joint_positions(motion), joint_positions(back)) < 1e-9);
}

TEST_CASE("pose features: a still root has features, and two still clips apart make a mover") {
  const Motion still = swinging(small_body(), 5, 30,
                                {"Hips", "LHip", "LLeg", "LShin", "LFoot", "RLeg", "RShin", "RFoot",
                                 "Neck", "LArm", "LHand", "RArm", "RHand"});
  CHECK(PoseFeatures::fit({&still}).dimension() == 6 + 4);
  Motion bent = still;
  bent.channels.col(still.skeleton.first_channel(still.skeleton.find("LShin"))).array() += 0.01;
  CHECK(PoseFeatures::fit({&still, &bent}).dimension() == 12 + 4);
}

TEST_CASE("pose features: skeletons are joined by name, whatever their channel and joint orders") {
  for (const Skeleton& skeleton : {small_body(), small_body_below_still_root()}) {
    const Motion motion = swinging(skeleton, 60, 30, {"LHand"});
    const PoseFeatures features = PoseFeatures::fit({&motion});
    const MatrixD encoded = features.encode(motion, kCamera);
    const Skeleton other = reordered(skeleton);
    REQUIRE(other.joints[2].name != skeleton.joints[2].name);
    const Motion on_other =
        features.decode(encoded, kCamera, other, 30, root_positions(features, motion));
    for (const Joint& joint : skeleton.joints) {
      CAPTURE(joint.name);
      CHECK(largest_difference(positions_of(motion, joint.name),
                               positions_of(on_other, joint.name)) < 1e-9);
    }
    CHECK(largest_difference(features.encode(on_other, kCamera), encoded) < 1e-9);
  }
}

TEST_CASE("pose features: another body keeps its own bones") {
  const Motion motion = swinging(small_body_below_still_root(), 30);
  const PoseFeatures features = PoseFeatures::fit({&motion});
  Skeleton tall = motion.skeleton;
  for (Joint& joint : tall.joints) joint.offset *= 1.5;
  const Motion on_tall = features.decode(features.encode(motion, kCamera), kCamera, tall, 30,
                                         root_positions(features, motion));
  const MatrixD bone = positions_of(on_tall, "LFoot") - positions_of(on_tall, "LShin");
  // Position channels lay 0.3 from the OFFSET in training, along each axis.
  const double length = (tall.joints[tall.find("LFoot")].offset.array() + 0.3).matrix().norm();
  CHECK((bone.rowwise().norm().array() - length).abs().maxCoeff() < 1e-9);
}

TEST_CASE("pose features: root height is along the world's up, velocity sums up to the path") {
  const Motion motion = swinging(small_body(), 50);
  const PoseFeatures features = PoseFeatures::fit({&motion});
  const MatrixD root = features.root_features(features.encode(motion, kCamera));
  const MatrixD path = positions_of(motion, "Hips");
  const double units = file_units_per_metre(motion.skeleton);
  CHECK(largest_difference(root.col(0) * units, path.col(1)) < 1e-9);
  CHECK(root.row(0).tail<3>() == root.row(1).tail<3>());
  Eigen::RowVector3d position = path.row(0);
  for (int frame = 1; frame < 50; ++frame) {
    position +=
        (kCamera.transpose() * root.row(frame).tail<3>().transpose()).transpose() * units / 30;
    CHECK((position - path.row(frame)).norm() < 1e-9);
  }
  Motion single = motion;
  single.channels.conservativeResize(1, Eigen::NoChange);
  CHECK(features.encode(single, kCamera).rightCols<3>().isZero());
}

TEST_CASE("pose features: camera-frame orientation is what the 6D block holds") {
  const Motion motion = swinging(small_body(), 3);
  const PoseFeatures features = PoseFeatures::fit({&motion});
  const MatrixD encoded = features.encode(motion, kCamera);
  const WorldPose pose = forward_kinematics(motion.skeleton, motion.channels.row(2));
  const std::vector<std::string> names = features.feature_names();
  const auto column = std::find(names.begin(), names.end(), "RHand_y_axis_z") - names.begin();
  REQUIRE(column < encoded.cols());
  const Eigen::Vector3d y_axis =
      kCamera * pose.world_from_joint[motion.skeleton.find("RHand")].col(1);
  CHECK(encoded(2, column) == doctest::Approx(y_axis.z()));
}

TEST_CASE("pose features: noisy and empty blocks still give rotations") {
  const Motion motion = swinging(small_body(), 30);
  const PoseFeatures features = PoseFeatures::fit({&motion});
  MatrixD encoded = features.encode(motion, kCamera);
  const MatrixD root = root_positions(features, motion);
  const Motion clean = features.decode(encoded, kCamera, motion.skeleton, 30, root);
  MatrixD scaled = encoded;
  scaled.leftCols(features.dimension() - 4) *= 0.3;  // length carries no information
  CHECK(largest_difference(
            joint_positions(features.decode(scaled, kCamera, motion.skeleton, 30, root)),
            joint_positions(clean)) < 1e-9);
  encoded.block(10, 12, 5, 6).setZero();
  const Motion held = features.decode(encoded, kCamera, motion.skeleton, 30, root);
  CHECK(held.channels.allFinite());
  const MatrixD again = features.encode(held, kCamera);
  CHECK(largest_difference(again.block(14, 12, 1, 6), encoded.block(9, 12, 1, 6)) < 1e-9);
}

TEST_CASE("pose features: the axis along a joint's longest bone leads, the other gives way") {
  const Motion motion = swinging(small_body(), 30);
  const PoseFeatures features = PoseFeatures::fit({&motion});
  const MatrixD encoded = features.encode(motion, kCamera), root = root_positions(features, motion);
  const auto block_of = [&](const std::string& name) {
    const auto found = std::ranges::find(features.joints(), motion.skeleton.find(name));
    return static_cast<int>(found - features.joints().begin());
  };
  // Bones are offsets of children and ends; a hand has none.
  for (const auto& [name, axis] : {std::pair{"Hips", 1},
                                   {"LLeg", 1},
                                   {"LShin", 1},
                                   {"Neck", 1},
                                   {"LArm", 0},
                                   {"RArm", 0},
                                   {"LHand", 0}}) {
    CAPTURE_BOUND(name);
    CHECK(features.leading_axis(block_of(name)) == axis);
  }
  for (const auto& [name, end] : {std::pair{"LLeg", "LShin"}, {"RArm", "RHand"}}) {
    CAPTURE_BOUND(name);
    const int block = 6 * block_of(name), leads = 3 * features.leading_axis(block_of(name));
    // Where the bone ends does not depend on the other axis, however far that is off.
    MatrixD askew = encoded;
    askew.middleCols<3>(block + 3 - leads) += 0.4 * encoded.middleCols<3>(block + leads);
    askew.middleCols<3>(block + 3 - leads).array() += 0.1;
    const Motion same = features.decode(askew, kCamera, motion.skeleton, 30, root);
    CHECK(largest_difference(positions_of(same, end), positions_of(motion, end)) < 1e-9);
    const MatrixD again = features.encode(same, kCamera);
    CHECK(largest_difference(again.middleCols<3>(block + leads),
                             encoded.middleCols<3>(block + leads)) < 1e-9);
    CHECK(largest_difference(again.middleCols<3>(block + 3 - leads),
                             encoded.middleCols<3>(block + 3 - leads)) > 0.05);
  }
  // A model that is read has the same axes.
  const PoseFeatures read = PoseFeatures::restored(features.skeleton(), features.root(),
                                                   features.joints(), features.fixed_channels());
  for (std::size_t k = 0; k < features.joints().size(); ++k)
    CHECK(read.leading_axis(static_cast<int>(k)) == features.leading_axis(static_cast<int>(k)));
}

TEST_CASE("pose features: what does not fit is refused") {
  const Motion motion = swinging(small_body(), 4);
  const PoseFeatures features = PoseFeatures::fit({&motion});
  Motion other = motion;
  other.skeleton.joints[3].name = "Knee";
  CHECK_THROWS_WITH_AS(PoseFeatures::fit({&motion, &other}), doctest::Contains("LShin"),
                       InputError);
  CHECK_THROWS_AS(features.encode(other, kCamera), InputError);
  const MatrixD encoded = features.encode(motion, kCamera);
  const MatrixD root = MatrixD::Zero(4, 3);
  CHECK_THROWS_AS(features.decode(encoded, kCamera, other.skeleton, 30, root), InputError);
  CHECK_THROWS_AS(features.decode(encoded, kCamera, motion.skeleton, 30, root.topRows(3)),
                  ShapeError);
  CHECK_THROWS_AS(features.decode(encoded.leftCols(9), kCamera, motion.skeleton, 30, root),
                  ShapeError);
  CHECK_THROWS_AS(features.root_features(encoded.leftCols(9)), ShapeError);
  CHECK_THROWS_AS(PoseFeatures::fit({}), InputError);
  Motion twins = motion;
  twins.skeleton.joints[4].name = "LShin";
  CHECK_THROWS_AS(PoseFeatures::fit({&twins}), InputError);
}

namespace {

/// What position channels that are not the root's stray from their mean may move a joint: they are
/// constants to the features (Bandai's wobble by rounding).
double position_wobble(const PoseFeatures& features, const Motion& motion) {
  double sum = 0;
  for (int j = 0; j < motion.skeleton.joint_count(); ++j) {
    if (j == features.root()) continue;
    const auto& channels = motion.skeleton.joints[j].channels;
    for (std::size_t k = 0; k < channels.size(); ++k) {
      if (is_rotation(channels[k])) continue;
      const auto column =
          motion.channels.col(motion.skeleton.first_channel(j) + static_cast<int>(k));
      sum += (column.array() - column.mean()).abs().maxCoeff();
    }
  }
  return sum;
}

}  // namespace

TEST_CASE("pose features: real files come back through their features") {
  for (const char* relative :
       {"cmu/walk/02_01.bvh", "cmu/walk/35_01.bvh", "cmu/other/14_14.bvh",
        "bandai/wave_both_hands/dataset-2_wave-both-hands_normal_001.bvh",
        "bandai/wave_right_hand/dataset-2_wave-right-hand_active_001.bvh", "bvh_zoo/bvh_test1.bvh",
        "bvh_zoo/bvh_test2.bvh", "bvh_zoo/dab.bvh", "bvh_zoo/example.bvh", "bvh_zoo/walk01.bvh",
        "bvh_zoo/test_freebvh.bvh", "bvh_zoo/rotation_first_root.bvh", "bvh_zoo/test_simple.bvh"}) {
    if (!test::have_shared_data(relative, "pose features of real files")) continue;
    CAPTURE(relative);
    const Motion motion = read_bvh(test::shared_data() / relative);
    const PoseFeatures features = PoseFeatures::fit({&motion});
    const Motion back = there_and_back(features, motion);
    const double wobble = position_wobble(features, motion);
    CHECK(wobble < 1e-3);
    CHECK(largest_difference(joint_positions(motion), joint_positions(back)) < 1e-6 + wobble);
  }
}
