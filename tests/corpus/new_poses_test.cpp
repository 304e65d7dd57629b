#include "corpus/new_poses.hpp"

#include <doctest/doctest.h>

#include <set>

#include "base/random_sequence.hpp"
#include "base/random_streams.hpp"
#include "corpus/humanoid_clips.hpp"
#include "corpus/no_augmentation.hpp"
#include "mcdbn/base/errors.hpp"
#include "motion/synthetic_motion.hpp"

namespace new_poses_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

using enum JointRole;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kFps = 30;

std::vector<LoadedClip> three_clips() {
  return {humanoid_clip(10, 20, 0), humanoid_clip(40, 30, 80), humanoid_clip(70, 40, -100)};
}

/// Largest step of a joint's rotation from frame to frame.
double largest_step_deg(const HumanoidPoses& poses, JointRole role) {
  double most = 0;
  for (int t = 1; t < poses.frames(); ++t)
    most = std::max(most, angle_deg(poses.local(t - 1, role).transpose() * poses.local(t, role)));
  return most;
}

/// The roles whose rotation against the joint above differs anywhere.
std::set<JointRole> changed_roles(const HumanoidPoses& a, const HumanoidPoses& b) {
  std::set<JointRole> changed;
  for (const JointRole role : joint_roles())
    for (int t = 0; t < a.frames(); ++t)
      if ((a.local(t, role) - b.local(t, role)).norm() > 1e-9) changed.insert(role);
  return changed;
}

}  // namespace

TEST_CASE("limbs exchanged: legs of the clip, upper body of another, an arm of a third") {
  const auto clips = three_clips();
  const PosePool pool(clips, kFps);
  const HumanoidPoses before(clips[0].motion);
  std::set<int> bends;
  bool arms_differ = false, heads_alike = true;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    HumanoidPoses poses = before;
    exchange_limbs(poses, pool, seed);
    CHECK(poses.root == before.root);
    for (const JointRole role : changed_roles(before, poses)) CHECK(is_below(role, spine));
    const int left = std::lround(angle_deg(poses.local(0, left_elbow))),
              right = std::lround(angle_deg(poses.local(0, right_elbow)));
    bends.insert({left, right});
    arms_differ = arms_differ || left != right;
    // It heads as the legs do: the donors' chests swing by 11 degrees about theirs.
    for (int t = 0; t < poses.frames(); ++t) {
      const Matrix3d chest_from_heading =
          heading_of(poses.local(t, pelvis)).transpose() * poses.world(t, chest);
      heads_alike = heads_alike && angle_deg(heading_of(chest_from_heading)) < 15;
    }
    HumanoidPoses again = before;
    exchange_limbs(again, pool, seed);
    CHECK(changed_roles(poses, again).empty());
  }
  CHECK(bends == std::set<int>{10, 40, 70});
  CHECK(arms_differ);
  CHECK(heads_alike);
}

TEST_CASE("limbs exchanged: the upper body leans in the world as it did there") {
  std::vector<LoadedClip> donors{humanoid_clip(30, 30, 50)};
  const PosePool pool(donors, kFps);
  HumanoidPoses poses(humanoid_clip(10, 20, 0).motion);
  for (int t = 0; t < poses.frames(); ++t)  // a pelvis tipped forward
    poses.local(t, pelvis) = Eigen::AngleAxisd(0.5, Vector3d::UnitX()).toRotationMatrix();
  exchange_limbs(poses, pool, 3);
  for (int t = 0; t < poses.frames(); ++t) {
    // The donor's spine and chest bend by 9 and 7 degrees and turn by 11 at most: never by 28.
    CHECK(std::acos(poses.world(t, chest)(1, 1)) * 180 / M_PI < 20);
  }
}

TEST_CASE("limbs turned: smoothly, within the limits, the pelvis as it was") {
  const auto clips = three_clips();
  const PosePool pool(clips, kFps);
  const HumanoidPoses before(clips[1].motion);
  HumanoidPoses poses = before, same = before, other = before;
  turn_limbs(poses, pool, 25, 5);
  turn_limbs(same, pool, 25, 5);
  turn_limbs(other, pool, 25, 6);
  CHECK(changed_roles(poses, same).empty());
  CHECK(changed_roles(poses, other).size() == 22);
  CHECK(poses.root == before.root);
  CHECK(changed_roles(before, poses).count(pelvis) == 0);
  for (const JointRole role : joint_roles()) {
    CAPTURE(std::string(name_of(role)));
    CHECK(largest_step_deg(poses, role) < largest_step_deg(before, role) + 12);
    for (int t = 0; t < poses.frames(); ++t) {
      const Matrix3d is = poses.local(t, role);
      CHECK(pool.limits(role).clamped(is, before.local(t, role)).isApprox(is, 1e-6));
    }
  }
  // Of joints that nothing limits the trunk's turn by half.
  std::vector<LoadedClip> free_clips;
  for (std::uint64_t i = 1; i <= 4; ++i) {
    HumanoidPoses wild = before;
    RandomSequence random(i);
    for (int t = 0; t < wild.frames(); ++t)
      for (const JointRole role : {chest, left_wrist}) {
        // One after the other: arguments would be drawn in an order of the compiler's own.
        const double z = random.normal(), y = random.normal(), x = random.normal(),
                     w = random.normal();
        wild.local(t, role) = Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
      }
    free_clips.push_back({{}, wild.motion()});
  }
  const PosePool free_pool(free_clips, kFps);
  double trunk = 0, limb = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    HumanoidPoses turned = before;
    turn_limbs(turned, free_pool, 15, seed);
    for (int t = 0; t < before.frames(); t += 10) {
      const auto turn = [&](JointRole role) {
        const double deg = angle_deg(before.local(t, role).transpose() * turned.local(t, role));
        return deg * deg / (3 * 9 * 20);
      };
      trunk += turn(chest);
      limb += turn(left_wrist);
    }
  }
  CHECK(std::sqrt(limb) == doctest::Approx(15).epsilon(0.25));
  CHECK(std::sqrt(trunk) == doctest::Approx(7.5).epsilon(0.25));
  turn_limbs(same = before, pool, 0, 5);
  CHECK(changed_roles(before, same).empty());
}

TEST_CASE("limits: a joint turns as far as the one of the other side was seen to") {
  HumanoidPoses poses(humanoid_clip(10, 20, 0).motion);
  const Matrix3d at_rest = poses.local(0, right_shoulder);
  for (int t = 0; t < poses.frames(); ++t) {
    const double turn = M_PI / 3 * t / (poses.frames() - 1);
    poses.local(t, left_shoulder) = Eigen::AngleAxisd(turn, Vector3d::UnitZ()).toRotationMatrix();
    poses.local(t, right_shoulder) = at_rest;
  }
  const PosePool pool(std::vector<LoadedClip>{{{}, poses.motion()}}, kFps);
  const Vector3d mirror(-1, 1, 1);
  for (const int t : {20, 45, 70}) {
    CAPTURE(t);
    const Matrix3d turned =
        mirror.asDiagonal() * poses.local(t, left_shoulder) * mirror.asDiagonal();
    CHECK(pool.limits(right_shoulder).clamped(turned, at_rest).isApprox(turned, 1e-6));
  }
}

TEST_CASE("arms anywhere: they point where no clip's do, but not far behind") {
  const HumanoidPoses before(humanoid_clip(10, 20, 70).motion);
  double highest = -1, lowest = 1, farthest_back = 1;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    HumanoidPoses poses = before;
    put_arms_anywhere(poses, seed);
    for (const JointRole role : changed_roles(before, poses))
      CHECK((role == left_shoulder || role == right_shoulder || role == left_elbow ||
             role == right_elbow));
    for (int t = 0; t < poses.frames(); ++t)
      for (const double side : {1.0, -1.0}) {
        const JointRole shoulder = side > 0 ? left_shoulder : right_shoulder;
        const Vector3d direction = poses.world(t, chest).transpose() *
                                   (poses.world(t, shoulder) * (side * Vector3d::UnitX()));
        highest = std::max(highest, direction.y());
        lowest = std::min(lowest, direction.y());
        farthest_back = std::min(farthest_back, direction.z());
        // Elbows bend forward, by at most 140 degrees.
        const Eigen::AngleAxisd bend(
            poses.local(t, other_side(shoulder) == left_shoulder ? right_elbow : left_elbow));
        CHECK(bend.angle() < 2.5);
        if (bend.angle() > 0.01) CHECK(bend.axis().y() * side == doctest::Approx(-1));
      }
    CHECK(largest_step_deg(poses, left_shoulder) < 30);
  }
  CHECK(highest > 0.9);
  CHECK(lowest < -0.9);
  CHECK(farthest_back < -0.3);
  CHECK(farthest_back > -0.95);
}

TEST_CASE("arms anywhere: a direction is drawn as z, y, x, whatever the compiler") {
  const HumanoidPoses before(humanoid_clip(10, 20, 70).motion);
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    HumanoidPoses poses = before;
    put_arms_anywhere(poses, seed);
    RandomSequence random(seed, random_streams::kNewPoses);
    Vector3d wanted;
    do {
      for (const int axis : {2, 1, 0}) wanted[axis] = random.normal();
      wanted.normalize();
    } while (wanted.z() < -0.5 || wanted.x() < -0.7);
    const Matrix3d chest_from_arm =
        poses.world(0, chest).transpose() * poses.world(0, left_shoulder);
    CHECK((chest_from_arm * Vector3d::UnitX() - wanted).norm() < 1e-9);
  }
}

TEST_CASE("leaning: the legs stand as they stood") {
  const HumanoidPoses before(humanoid_clip(10, 20, 70).motion);
  double sum = 0;
  constexpr int kSeeds = 60;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    HumanoidPoses poses = before;
    lean(poses, 15, seed);
    CHECK(changed_roles(before, poses) == std::set<JointRole>{pelvis, left_hip, right_hip});
    for (int t = 0; t < poses.frames(); t += 10) {
      CHECK(poses.world(t, left_hip).isApprox(before.world(t, left_hip)));
      CHECK(poses.world(t, right_hip).isApprox(before.world(t, right_hip)));
      const double tilt = std::acos(poses.local(t, pelvis)(1, 1)) * 180 / M_PI;
      sum += tilt * tilt / (2 * 9 * kSeeds);
    }
  }
  CHECK(std::sqrt(sum) == doctest::Approx(15).epsilon(0.25));
}

TEST_CASE("turning round: the path turns with the body, at its speed") {
  const HumanoidPoses before(humanoid_clip(10, 20, 0).motion);
  double widest = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    HumanoidPoses poses = before;
    turn_round(poses, seed);
    CHECK(changed_roles(before, poses) == std::set<JointRole>{pelvis});
    for (int t = 1; t < poses.frames(); ++t) {
      const Vector3d was = (before.root.row(t) - before.root.row(t - 1)).transpose(),
                     is = (poses.root.row(t) - poses.root.row(t - 1)).transpose();
      const Matrix3d turn = poses.local(t, pelvis) * before.local(t, pelvis).transpose();
      CHECK((turn * was - is).norm() < 1e-9);
      CHECK(turn(1, 1) == doctest::Approx(1));
      widest = std::max(widest, angle_deg(turn));
    }
  }
  CHECK(widest > 90);
}

TEST_CASE("new poses: each in its share of the views, bones and feet kept") {
  const auto clips = three_clips();
  const PosePool pool(clips, kFps);
  const Motion& motion = clips[0].motion;
  const HumanoidPoses before(motion);
  struct Case {
    double AugmentationSettings::*share;
    JointRole changes, stays;
  };
  for (const auto& [share, changes, stays] :
       {Case{&AugmentationSettings::limbs_exchanged, chest, left_knee},
        Case{&AugmentationSettings::limbs_turned, left_knee, pelvis},
        Case{&AugmentationSettings::arms_anywhere, left_elbow, chest},
        Case{&AugmentationSettings::leaning, left_hip, chest},
        Case{&AugmentationSettings::turning_round, pelvis, chest}}) {
    AugmentationSettings settings = nothing();
    CHECK_FALSE(settings.new_poses());
    settings.*share = 0.5;
    CHECK(settings.new_poses());
    int changed = 0;
    constexpr int kViews = 60;
    for (std::uint32_t i = 0; i < kViews; ++i) {
      const Motion made = with_new_poses(motion, settings, pool, {8, i, 0, 0});
      CHECK(made.channels == with_new_poses(motion, settings, pool, {8, i, 0, 0}).channels);
      const HumanoidPoses poses(made);
      const auto roles = changed_roles(before, poses);
      CHECK(roles.count(stays) == 0);
      changed += !roles.empty();
      if (share != &AugmentationSettings::limbs_exchanged && !roles.empty())
        CHECK(roles.count(changes) == 1);
      CHECK((poses.lowest_foot() - before.lowest_foot()).cwiseAbs().maxCoeff() < 1e-6);
      for (std::size_t j = 0; j < made.skeleton.joints.size(); ++j)
        CHECK(made.skeleton.joints[j].offset == motion.skeleton.joints[j].offset);
    }
    // Five deviations of the binomial distribution.
    CHECK(std::abs(changed - kViews / 2) < 5 * std::sqrt(kViews / 4.0));
  }
  CHECK(with_new_poses(motion, nothing(), pool, {8, 1, 0, 0}).channels == motion.channels);
}

TEST_CASE("new poses are of the humanoid alone; a piece goes back where its clip ends") {
  std::vector<LoadedClip> clips{{{}, swinging(small_body(), 5)}};
  CHECK_THROWS_AS(PosePool(clips, kFps), ConfigError);
  clips = {humanoid_clip(10, 20, 0, 10)};
  const PosePool pool(clips, kFps);
  const HumanoidPoses piece = pool.piece(0, 0.7, 25);
  REQUIRE(piece.frames() == 25);
  CHECK(piece.local(10, chest).isApprox(piece.local(8, chest)));
  CHECK(piece.local(18, chest).isApprox(piece.local(0, chest)));
  CHECK(piece.local(9, chest).isApprox(HumanoidPoses(clips[0].motion).local(9, chest)));
}

}  // namespace new_poses_test
