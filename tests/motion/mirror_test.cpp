#include "motion/mirror.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "base/capture_bound.hpp"
#include "mcdbn/formats/motion_file.hpp"
#include "shared_data.hpp"

using namespace mcdbn;

namespace {

/// Two arms on a spine. `straight`: the arms rest to both sides; else every bone rests along +x,
/// and only the sides' positions at the shoulders differ.
Motion two_armed(bool straight) {
  const auto joint = [](const char* name, int parent, Eigen::Vector3d offset, bool root = false) {
    Joint result;
    result.name = name;
    result.parent = parent;
    result.offset = offset;
    if (root) result.channels = {Channel::x_position, Channel::y_position, Channel::z_position};
    for (const Channel channel : {Channel::z_rotation, Channel::x_rotation, Channel::y_rotation})
      result.channels.push_back(channel);
    return result;
  };
  Motion motion;
  if (straight)
    motion.skeleton.joints = {joint("Hips", -1, {0, 0, 0}, true), joint("LeftArm", 0, {3, 9, 1}),
                              joint("LeftHand", 1, {5, -1, 2}), joint("RightArm", 0, {-3, 9, 1}),
                              joint("RightHand", 3, {-5, -1, 2})};
  else
    motion.skeleton.joints = {joint("Hips", -1, {0, 0, 0}, true), joint("Arm_L", 0, {3, 9, 1}),
                              joint("Hand_L", 1, {5, 0, 0}), joint("Arm_R", 0, {-3, 9, 1}),
                              joint("Hand_R", 3, {5, 0, 0})};
  motion.channels = MatrixD::Zero(20, motion.skeleton.channel_count());
  for (Eigen::Index t = 0; t < 20; ++t)
    for (Eigen::Index c = 0; c < motion.channels.cols(); ++c)
      motion.channels(t, c) =
          35.0 * std::sin(0.3 * static_cast<double>(t) + 0.9 * static_cast<double>(c));
  return motion;
}

MatrixD seen_in_mirror(const Motion& motion) {
  MatrixD positions = joint_positions(motion);
  for (Eigen::Index c = 0; c < positions.cols(); c += 3) positions.col(c) *= -1.0;
  const MatrixD left = positions.middleCols(3, 6);
  positions.middleCols(3, 6) = positions.middleCols(9, 6);
  positions.middleCols(9, 6) = left;
  return positions;
}

}  // namespace

TEST_CASE("a mirrored motion stands where the mirror shows the other side") {
  for (const bool straight : {true, false}) {
    CAPTURE(straight);
    const Motion motion = two_armed(straight);
    const auto other = mirrored(motion);
    REQUIRE(other);
    // Angles go through sines and back: some hundred roundings of numbers up to 60.
    CHECK((joint_positions(*other) - seen_in_mirror(motion)).cwiseAbs().maxCoeff() < 1e-11);
    const auto back = mirrored(*other);
    REQUIRE(back);
    // Every channel, those of the leaves too, which move no joint.
    CHECK((back->channels - motion.channels).cwiseAbs().maxCoeff() < 1e-11);
    CHECK(other->frame_time_s == motion.frame_time_s);
  }
}

TEST_CASE("a mirrored body of both sides alike turns every joint as the mirror shows it") {
  const Motion motion = two_armed(true);
  const auto other = mirrored(motion);
  REQUIRE(other);
  const Eigen::Vector3d turn(-1, 1, -1);  // z, x, y: about the mirror's own axis as it was
  const std::vector<int> opposite{0, 3, 4, 1, 2};
  for (int j = 0; j < 5; ++j) {
    CAPTURE(j);
    const int own = motion.skeleton.first_channel(j) + (j == 0 ? 3 : 0);
    const int there = motion.skeleton.first_channel(opposite[j]) + (j == 0 ? 3 : 0);
    const MatrixD want = motion.channels.middleCols(there, 3) * turn.asDiagonal();
    CHECK((other->channels.middleCols(own, 3) - want).cwiseAbs().maxCoeff() < 1e-11);
  }
  CHECK(other->channels.col(0) == -motion.channels.col(0));
  CHECK(other->channels.middleCols(1, 2) == motion.channels.middleCols(1, 2));
}

TEST_CASE("mirrored joints whose bones all rest along x are reflected as suits the motion") {
  const Eigen::Vector3d mirror(-1, 1, 1);
  const std::vector<int> opposite{0, 3, 4, 1, 2};
  // Half a turn about z or y brings the right arm to the right. With the mirror that is a
  // reflection along y or z.
  for (const auto& [channel, bones] :
       {std::pair(0, Eigen::Vector3d(1, -1, 1)), std::pair(2, Eigen::Vector3d(1, 1, -1))}) {
    CAPTURE_BOUND(channel);
    Motion motion = two_armed(false);
    motion.channels.col(motion.skeleton.first_channel(3) + channel).array() += 180.0;
    const auto other = mirrored(motion);
    REQUIRE(other);
    for (const int t : {0, 7, 19}) {
      const WorldPose before = forward_kinematics(motion.skeleton, motion.channels.row(t));
      const WorldPose after = forward_kinematics(motion.skeleton, other->channels.row(t));
      for (int j = 0; j < 5; ++j) {  // the hands, which have no bone, as their arms
        CAPTURE(j);
        const Eigen::Vector3d own = j == 0 ? mirror : bones;
        const Eigen::Matrix3d want =
            mirror.asDiagonal() * before.world_from_joint[opposite[j]] * own.asDiagonal();
        CHECK((after.world_from_joint[j] - want).cwiseAbs().maxCoeff() < 1e-12);
      }
    }
  }
}

TEST_CASE("mirrored angles run on continuously past half a turn") {
  Motion motion = two_armed(true);
  const int turn = motion.skeleton.first_channel(0) + 5;
  motion.channels.leftCols(6).setZero();
  for (int t = 0; t < 20; ++t) motion.channels(t, turn) = 40.0 * t;
  const auto other = mirrored(motion);
  REQUIRE(other);
  CHECK((other->channels.col(turn) + motion.channels.col(turn)).cwiseAbs().maxCoeff() < 1e-10);
}

TEST_CASE("sides are named by words, and by letters at either end of a name") {
  const auto opposite_of = [](const char* left, const char* right) {
    Motion motion = two_armed(true);
    motion.skeleton.joints[1].name = left;
    motion.skeleton.joints[2].name = "LeftHand";
    motion.skeleton.joints[3].name = right;
    motion.skeleton.joints[4].name = "RightHand";
    return opposite_joints(motion.skeleton);
  };
  const std::vector<int> both{0, 3, 4, 1, 2};
  CHECK(opposite_of("LeftArm", "RightArm") == both);
  CHECK(opposite_of("arm_left", "arm_right") == both);
  CHECK(opposite_of("Arm_L", "Arm_R") == both);
  CHECK(opposite_of("arm.l", "arm.r") == both);
  CHECK(opposite_of("LArm", "RArm") == both);
  CHECK(opposite_of("L_arm", "R_arm") == both);
  CHECK(opposite_of("l_arm", "r_arm") == both);
  CHECK(opposite_of("lArm", "rArm") == both);
  CHECK(opposite_of("larm", "rarm") == both);
  CHECK(opposite_of("armL", "armR") == both);
  CHECK(opposite_of("Bip01 L Arm", "Bip01 R Arm") == both);
  CHECK(opposite_of("J_Bip_L_Arm", "J_Bip_R_Arm") == both);
  CHECK(opposite_of("arm.L.001", "arm.R.001") == both);
  // No mark: the hands would hang on arms that are no pair.
  CHECK(opposite_of("collar", "corral").empty());
  CHECK(opposite_of("balk", "bark").empty());
  CHECK(opposite_of("larm", "Rarm").empty());
  CHECK(opposite_of("larm", "rhand").empty());
}

TEST_CASE("letters mark sides only where parents are the same or a pair") {
  Motion motion = two_armed(true);
  const auto named = [&](const std::vector<const char*>& names) {
    for (std::size_t j = 0; j < names.size(); ++j) motion.skeleton.joints[j].name = names[j];
    return opposite_joints(motion.skeleton);
  };
  CHECK(named({"root", "lfemur", "ltibia", "rfemur", "rtibia"}) == std::vector<int>{0, 3, 4, 1, 2});
  CHECK(named({"root", "lfemur", "lower", "rfemur", "rtibia"}).empty());
  motion.skeleton.joints[4].parent = 0;
  CHECK(named({"root", "lfemur", "ltibia", "rfemur", "rtibia"}).empty());
  // What is in the middle stays there, whatever its name begins with.
  motion.skeleton.joints[4].parent = 2;
  CHECK(named({"root", "lfemur", "lowerback", "rfemur", "rear"}).empty());
  motion.skeleton.joints[2].parent = 0;
  CHECK(named({"root", "lfemur", "lowerback", "rfemur", "rear"}) ==
        std::vector<int>{0, 3, 2, 1, 4});
}

TEST_CASE("a skeleton of ASF has two sides, and its motion a mirrored one") {
  const auto file = test::shared_data() / "formats/cmu_asf_amc/16_15.amc";
  if (!test::have_shared_data("formats/cmu_asf_amc/16_15.amc", "the sides of an ASF")) return;
  const Motion motion = read_motion(file);
  const Skeleton& skeleton = motion.skeleton;
  const std::vector<int> opposite = opposite_joints(skeleton);
  REQUIRE(!opposite.empty());
  int pairs = 0;
  for (int j = 0; j < skeleton.joint_count(); ++j) {
    const std::string& name = skeleton.joints[static_cast<std::size_t>(j)].name;
    CAPTURE(name);
    const bool left = name.starts_with('l') && !name.starts_with("lower");
    const int there = left ? skeleton.find("r" + name.substr(1)) : -1;
    if (left) REQUIRE(there >= 0);
    if (left) CHECK(opposite[static_cast<std::size_t>(there)] == j);
    if (name.starts_with('r') && name != "root") continue;
    CHECK(opposite[static_cast<std::size_t>(j)] == (left ? there : j));
    pairs += left ? 1 : 0;
  }
  CHECK(pairs == 12);  // five of a leg, seven of an arm
  const auto other = mirrored(motion);
  REQUIRE(other);
  // The bones from the root to the foot differ from their mirror images by 1.5 cm in all.
  const MatrixD before = joint_positions(motion), after = joint_positions(*other);
  const int left = skeleton.find("lfoot"), right = skeleton.find("rfoot");
  const Eigen::Vector3d mirror(-1, 1, 1);
  for (Eigen::Index t = 0; t < before.rows(); t += 20) {
    CAPTURE(t);
    const Eigen::Vector3d was = mirror.cwiseProduct(before.row(t).segment<3>(3 * left).transpose());
    CHECK((after.row(t).segment<3>(3 * right).transpose() - was).norm() < 1.6);
  }
}

TEST_CASE("a bone that leans by a hair does not turn its joint round in the mirror") {
  Motion motion = two_armed(true);
  Joint head;
  head.name = "Head";
  head.parent = 0;
  head.offset = {0.05, 6, 0.2};
  head.channels = {Channel::z_rotation, Channel::x_rotation, Channel::y_rotation};
  Joint crown = head;
  crown.name = "Crown";
  crown.parent = 5;
  crown.offset = {0.1, 2, 0.01};  // turned half round y it would be off itself by less
  motion.skeleton.joints.push_back(head);
  motion.skeleton.joints.push_back(crown);
  const int first = motion.skeleton.first_channel(5);
  motion.channels = MatrixD::Zero(20, motion.skeleton.channel_count());
  motion.channels.col(first + 2).setConstant(20.0);  // y, the head looks aside
  const auto other = mirrored(motion);
  REQUIRE(other);
  CHECK((other->channels.col(first + 2).array() + 20.0).abs().maxCoeff() < 1e-11);
  CHECK(other->channels.middleCols(first, 2).cwiseAbs().maxCoeff() < 1e-11);
}

TEST_CASE("without sides, or with sides that differ, there is no mirrored motion") {
  Motion nameless = two_armed(true);
  for (Joint& joint : nameless.skeleton.joints)
    joint.name = "j" + std::to_string(&joint - nameless.skeleton.joints.data());
  CHECK_FALSE(mirrored(nameless));
  Motion lopsided = two_armed(true);
  lopsided.skeleton.joints[4].offset = {0, -20, 0};
  CHECK_FALSE(mirrored(lopsided));
  Motion crossed = two_armed(true);
  crossed.skeleton.joints[4].parent = 1;  // both hands on one arm
  CHECK_FALSE(mirrored(crossed));
}
