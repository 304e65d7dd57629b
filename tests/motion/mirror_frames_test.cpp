// Mirrored motion of skeletons whose joints have frames of their own, as Bandai's: right limbs rest
// along -x where left ones rest along +x.

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "mcdbn/formats/bvh.hpp"
#include "mcdbn/motion/humanoid.hpp"
#include "motion/joint_matching.hpp"
#include "motion/mirror.hpp"
#include "motion/synthetic_motion.hpp"
#include "shared_data.hpp"

namespace mirror_frames_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

const Vector3d kMirror(-1, 1, 1);

Matrix3d turned(double degrees, const Vector3d& about) {
  return Eigen::AngleAxisd(degrees * M_PI / 180, about.normalized()).toRotationMatrix();
}

/// A joint, its frame in one who stands, faces +z and has the left at +x, and the diagonal of the
/// reflection that makes this frame of the other side's in the mirror.
struct Standing {
  Joint joint;
  Matrix3d world_from_joint;
  Vector3d reflection;
};

/// The left limbs stand in any frames; the right ones in their mirror images with all axes the
/// other way.
std::vector<Standing> standing_body() {
  const std::vector<Channel> turns{x_rotation, y_rotation, z_rotation};
  const std::vector<Channel> all{x_position, y_position, z_position,
                                 x_rotation, y_rotation, z_rotation};
  Matrix3d hips, trunk;
  hips << 0, -1, 0, 1, 0, 0, 0, 0, 1;  // x up, y to the right, z ahead
  trunk << 0, 0, 1, 1, 0, 0, 0, 1, 0;  // x up, y ahead, z to the left
  const Vector3d along_y(1, -1, 1), along_z(1, 1, -1), along_all(-1, -1, -1);
  std::vector<Standing> body{
      {make_joint("World", -1, {0, 0, 0}, all), Matrix3d::Identity(), kMirror},
      // Where the clip stands, no bone.
      {make_joint("Hips", 0, {400, 90, 300}, all), hips, along_y},
      {make_joint("Spine", 1, {15, 0, 0}, turns), trunk, along_z},
      {make_joint("Chest", 2, {9, -0.4, 0}, turns), trunk, along_z},
      {make_joint("Head", 3, {20, 0, 0}, turns), trunk, along_z}};
  const auto add_limb = [&](const std::string& upper, const std::string& lower, int parent,
                            const Vector3d& left, const Vector3d& right, double length,
                            const Matrix3d& frame, const Matrix3d& lower_frame) {
    for (const double sign : {1.0, -1.0}) {
      const auto placed = [&](const Matrix3d& of_left) -> Matrix3d {
        return sign > 0 ? of_left : Matrix3d(kMirror.asDiagonal() * of_left * -1.0);
      };
      const std::string side = sign > 0 ? "_L" : "_R";
      const int top = static_cast<int>(body.size());
      body.push_back({make_joint(upper + side, parent, sign > 0 ? left : right, turns),
                      placed(frame), along_all});
      body.push_back({make_joint(lower + side, top, {sign * length, 0, 0}, turns),
                      placed(lower_frame), along_all});
    }
  };
  add_limb("Arm", "Hand", 3, {13, 0, 5}, {13, 0, -5}, 24, turned(-80, {0.2, 0.3, 1}),
           turned(-100, {-0.1, 0.2, 1}));
  add_limb("Leg", "Foot", 1, {-2, -6, 0}, {-2, 6, 0}, 39, turned(-90, {0.1, -0.2, 1}),
           turned(130, {0.3, 1, -0.5}));
  return body;
}

/// @param swing_deg how far each joint turns away from how it stands, each at its own pace
Motion moving(const std::vector<Standing>& body, double swing_deg) {
  constexpr int kFrames = 40;
  Motion motion;
  for (const Standing& standing : body) motion.skeleton.joints.push_back(standing.joint);
  motion.channels = MatrixD::Zero(kFrames, motion.skeleton.channel_count());
  for (int t = 0; t < kFrames; ++t)
    for (int j = 1; j < motion.skeleton.joint_count(); ++j) {
      const Joint& joint = motion.skeleton.joints[static_cast<std::size_t>(j)];
      const Matrix3d& above = body[static_cast<std::size_t>(joint.parent)].world_from_joint;
      const Matrix3d swing = turned(swing_deg * std::sin(0.2 * t + 1.7 * j),
                                    {std::sin(1.0 * j), std::cos(2.0 * j), std::sin(3.0 * j)});
      double* channels = motion.channels.row(t).data() + motion.skeleton.first_channel(j);
      set_local_rotation(
          joint, above.transpose() * body[static_cast<std::size_t>(j)].world_from_joint * swing,
          nullptr, channels);
      if (joint.name != "Hips") continue;
      channels[0] = swing_deg * t;  // one who does not swing stands in the mirror's plane
      channels[1] = 90;
      channels[2] = 3.0 * t;
    }
  return motion;
}

/// How far the frames of `after` are from those of `before` in the mirror.
/// @param reflection of each joint's own axes
double off_mirror(const Motion& before, const Motion& after,
                  const std::vector<Vector3d>& reflection) {
  const std::vector<int> opposite = opposite_joints(before.skeleton);
  double most = 0;
  for (int t = 0; t < before.frames(); ++t) {
    const WorldPose was = forward_kinematics(before.skeleton, before.channels.row(t));
    const WorldPose is = forward_kinematics(after.skeleton, after.channels.row(t));
    for (std::size_t j = 0; j < reflection.size(); ++j) {
      const auto there = static_cast<std::size_t>(opposite[j]);
      const Matrix3d want =
          kMirror.asDiagonal() * was.world_from_joint[there] * reflection[j].asDiagonal();
      most = std::max({most, (is.world_from_joint[j] - want).cwiseAbs().maxCoeff(),
                       (is.position[j] - kMirror.cwiseProduct(was.position[there])).norm()});
    }
  }
  return most;
}

/// Of Bandai's skeleton: the hips' left leg is at -y, the chest's left arm at +z, limbs of both
/// sides rest opposite ways; the spine stands with the chest's axes, a quarter turned from the
/// hips'.
std::vector<Vector3d> reflections_of_bandai(const Skeleton& skeleton) {
  std::vector<Vector3d> reflection;
  for (const Joint& joint : skeleton.joints) {
    const bool limb = joint.name.ends_with("_L") || joint.name.ends_with("_R");
    if (joint.name == "joint_Root")
      reflection.push_back(kMirror);
    else if (joint.name == "Hips")
      reflection.emplace_back(1, -1, 1);
    else
      reflection.push_back(limb ? Vector3d(-1, -1, -1) : Vector3d(1, 1, -1));
  }
  return reflection;
}

}  // namespace

TEST_CASE("one who stands alike on both sides is the same in the mirror, whatever the frames") {
  const Motion motion = moving(standing_body(), 0);
  const auto other = mirrored(motion);
  REQUIRE(other);
  for (const int t : {0, 39}) {
    const WorldPose before = forward_kinematics(motion.skeleton, motion.channels.row(t));
    const WorldPose after = forward_kinematics(motion.skeleton, other->channels.row(t));
    for (std::size_t j = 0; j < motion.skeleton.joints.size(); ++j) {
      CAPTURE(motion.skeleton.joints[j].name);
      CHECK((after.world_from_joint[j] - before.world_from_joint[j]).cwiseAbs().maxCoeff() < 1e-9);
    }
  }
}

TEST_CASE("frames that point opposite ways on both sides are reflected along all axes") {
  const std::vector<Standing> body = standing_body();
  std::vector<Vector3d> reflection;
  for (const Standing& standing : body) reflection.push_back(standing.reflection);
  const Motion motion = moving(body, 25);
  const auto other = mirrored(motion);
  REQUIRE(other);
  CHECK(off_mirror(motion, *other, reflection) < 1e-9);
  const auto back = mirrored(*other);
  REQUIRE(back);
  CHECK((joint_positions(*back) - joint_positions(motion)).cwiseAbs().maxCoeff() < 1e-9);
  CHECK(off_mirror(*other, *back, reflection) < 1e-9);
}

TEST_CASE("where one reflection fits all bones the motion does not matter") {
  Motion motion;
  motion.skeleton = canonical_humanoid();
  motion.channels = MatrixD::Zero(10, motion.skeleton.channel_count());
  // Turned by this, the chest would be more like itself if its z were reflected.
  const int chest = humanoid_roles().joint(JointRole::chest);
  const int about_y =
      find_channel(motion.skeleton.joints[static_cast<std::size_t>(chest)], Channel::y_rotation);
  motion.channels.col(motion.skeleton.first_channel(chest) + about_y).setConstant(80);
  const auto other = mirrored(motion);
  REQUIRE(other);
  CHECK((other->channels + motion.channels).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE("CMU's joints are reflected along x in every clip") {
  for (const char* relative : {"cmu/walk/02_01.bvh", "cmu/walk/08_10.bvh", "cmu/other/14_14.bvh"}) {
    if (!have_shared_data(relative, "CMU in the mirror")) continue;
    CAPTURE(relative);
    const Motion motion = read_bvh(shared_data() / relative);
    const auto other = mirrored(motion);
    REQUIRE(other);
    const std::vector<int> opposite = opposite_joints(motion.skeleton);
    for (int j = 0; j < motion.skeleton.joint_count(); ++j) {
      const auto own = static_cast<std::size_t>(j), there = static_cast<std::size_t>(opposite[own]);
      CAPTURE(motion.skeleton.joints[own].name);
      const int first = motion.skeleton.first_channel(j),
                first_there = motion.skeleton.first_channel(opposite[own]);
      for (int t = 0; t < motion.frames(); t += 10) {
        const Matrix3d was = local_rotation(motion.skeleton.joints[there],
                                            motion.channels.row(t).data() + first_there);
        const Matrix3d is =
            local_rotation(motion.skeleton.joints[own], other->channels.row(t).data() + first);
        const Matrix3d want = kMirror.asDiagonal() * was * kMirror.asDiagonal();
        REQUIRE((is - want).cwiseAbs().maxCoeff() < 1e-6);
      }
    }
  }
}

TEST_CASE("Bandai's joints are reflected alike in every clip, and none is turned half round") {
  // The last two move one side otherwise than the other throughout.
  for (const char* name : {"walk-back_active", "bye_masculinity", "byebye_feminine"}) {
    const std::string relative = std::string("bandai/set1/dataset-1_") + name + "_001.bvh";
    if (!have_shared_data(relative, "Bandai in the mirror")) continue;
    CAPTURE(name);
    const Motion motion = read_bvh(shared_data() / relative);
    const auto other = mirrored(motion);
    REQUIRE(other);
    CHECK(off_mirror(motion, *other, reflections_of_bandai(motion.skeleton)) < 1e-6);
    if (std::string(name) != "walk-back_active") continue;
    for (int j = 2; j < motion.skeleton.joint_count(); ++j) {
      const Joint& joint = motion.skeleton.joints[static_cast<std::size_t>(j)];
      CAPTURE(joint.name);
      const int first = motion.skeleton.first_channel(j);
      double sum_deg = 0;
      for (int t = 0; t < motion.frames(); ++t) {
        const Matrix3d was = local_rotation(joint, motion.channels.row(t).data() + first),
                       is = local_rotation(joint, other->channels.row(t).data() + first);
        sum_deg += Eigen::AngleAxisd(was.transpose() * is).angle() * 180 / M_PI;
      }
      CHECK(sum_deg / motion.frames() < 90);
    }
  }
}

}  // namespace mirror_frames_test
