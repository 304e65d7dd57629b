#include "mcdbn/motion/mirror.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "mcdbn/motion/bvh.hpp"

using namespace mcdbn;

namespace {

/// Two arms on a spine. `straight`: the arms rest to both sides; else every bone rests along +x, as
/// Bandai's do, and only the sides' places at the shoulders differ.
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
    CHECK((joint_positions(*back) - joint_positions(motion)).cwiseAbs().maxCoeff() < 1e-11);
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
  crown.offset = {0.1, 2, 0.01};  // turned half round y it would miss itself by less
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
