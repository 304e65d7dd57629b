#include "mcdbn/motion/humanoid.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "mcdbn/formats/bvh.hpp"
#include "motion/body_size.hpp"
#include "motion/humanoid_motion.hpp"
#include "motion/mirror.hpp"
#include "motion/rest_pose.hpp"

namespace humanoid_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

Eigen::Matrix3d about(double deg, const Eigen::Vector3d& axis) {
  return Eigen::AngleAxisd(deg * M_PI / 180, axis).toRotationMatrix();
}

/// Down and up within 121 frames while it turns round: hips and trunk bend beyond 90 degrees, knees
/// and elbows by 140, arms rise before it and above its head, wrists turn and bend, and everything
/// sways a little.
/// @param skeleton the humanoid with any orders of axes
Motion squat(const Skeleton& skeleton) {
  using enum JointRole;
  const Eigen::Vector3d x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  Motion motion{skeleton, 1.0 / 30, MatrixD::Zero(121, skeleton.channel_count())};
  for (int t = 0; t < motion.frames(); ++t) {
    const double down = 0.5 - 0.5 * std::cos(2 * M_PI * t / 60);
    const auto sway = [&](double phase) { return std::sin(0.4 * t + phase); };
    const auto set = [&](JointRole role, const Eigen::Matrix3d& turn) {
      const auto joint = static_cast<std::size_t>(humanoid_roles().joint(role));
      const int first = skeleton.first_channel(humanoid_roles().joint(role));
      set_local_rotation(skeleton.joints[joint], turn,
                         t > 0 ? motion.channels.row(t - 1).data() + first : nullptr,
                         motion.channels.row(t).data() + first);
    };
    set(pelvis, about(3 * t, y) * about(100 * down, x) * about(4 * sway(1), z));
    set(spine, about(45 * down, x) * about(3 * sway(1), z) * about(5 * sway(2), y));
    set(neck, about(70 * sway(0) * down, y) * about(60 * down, x) * about(8 * sway(1), z));
    for (const bool right : {false, true}) {
      const double side = right ? -1 : 1;
      const auto of = [&](JointRole left) { return right ? other_side(left) : left; };
      set(of(left_hip), about(-125 * down, x) * about(side * (12 + 3 * sway(1)), z) *
                            about(side * (10 + 4 * sway(2)), y));
      set(of(left_knee), about(140 * down, x) * about(1.5 * sway(3), z) *
                             about(side * (8 * down + 2 * sway(0)), y));
      set(of(left_ankle), about(-35 * down, x) * about(side * 12, y) * about(4 * sway(1), z));
      set(of(left_shoulder), about(-170 * down, x) * about(side * -75, z) * about(10 * sway(2), y));
      set(of(left_elbow),
          about(side * -145 * down, y) * about(2 * sway(1), z) * about(60 * down, x));
      set(of(left_wrist),
          about(80 * down, x) * about(10 * sway(2), y) * about(side * 70 * sway(1), z));
    }
  }
  return motion;
}

/// How many times as far as the joint an angle turns from one frame to the next, at most.
double largest_gain(const Motion& motion, int joint) {
  const Joint& of = motion.skeleton.joints[static_cast<std::size_t>(joint)];
  const int first = motion.skeleton.first_channel(joint);
  const auto count = static_cast<Eigen::Index>(of.channels.size());
  double gain = 0;
  for (int t = 1; t < motion.frames(); ++t) {
    const auto rotation = [&](int frame) {
      return local_rotation(of, motion.channels.row(frame).data() + first);
    };
    const double turn_deg =
        Eigen::AngleAxisd(rotation(t - 1).transpose() * rotation(t)).angle() * 180 / M_PI;
    const double step_deg = (motion.channels.row(t) - motion.channels.row(t - 1))
                                .segment(first + count - 3, 3)
                                .cwiseAbs()
                                .maxCoeff();
    if (step_deg > 0.01) gain = std::max(gain, step_deg / turn_deg);
  }
  return gain;
}

}  // namespace

TEST_CASE("the humanoid: a joint for each role, in a T-pose of a body's proportions") {
  using enum JointRole;
  const Skeleton& humanoid = canonical_humanoid();
  CHECK(humanoid.joint_count() == 23);
  CHECK(is_humanoid(humanoid));
  CHECK(body_height(humanoid) == doctest::Approx(170).epsilon(1e-9));
  const SkeletonRoles found = skeleton_roles(humanoid);
  const WorldPose rest = rest_pose(humanoid);
  const auto place = [&](JointRole role) { return rest.position[humanoid_roles().joint(role)]; };
  for (const JointRole role : joint_roles()) {
    CAPTURE(std::string(name_of(role)));
    CHECK(found.joint(role) == humanoid_roles().joint(role));
    CHECK(humanoid.joints[humanoid_roles().joint(role)].name == name_of(role));
    const Eigen::Vector3d mirrored = place(role).cwiseProduct(Eigen::Vector3d(-1, 1, 1));
    CHECK((place(other_side(role)) - mirrored).norm() < 1e-12);
  }
  // Shares of stature, above the soles: the pelvis is at 0.57.
  const double soles = place(pelvis).y() - 0.57 * 170;
  CHECK(place(left_hip).y() - soles == doctest::Approx(0.530 * 170));
  CHECK(place(left_knee).y() - soles == doctest::Approx(0.285 * 170));
  CHECK(place(left_ankle).y() - soles == doctest::Approx(0.039 * 170));
  CHECK(place(left_shoulder).y() - soles == doctest::Approx(0.818 * 170));
  CHECK(place(left_shoulder).x() == doctest::Approx(0.129 * 170));
  CHECK(place(neck).y() - soles == doctest::Approx(0.840 * 170));
  CHECK(place(head).y() - soles == doctest::Approx(0.910 * 170));
  CHECK(humanoid.joints[humanoid_roles().joint(head)].end_sites.at(0).y() + place(head).y() -
            soles ==
        doctest::Approx(170));
  CHECK(place(left_elbow).x() - place(left_shoulder).x() == doctest::Approx(0.186 * 170));
  CHECK(place(left_wrist).x() - place(left_elbow).x() == doctest::Approx(0.146 * 170));
  CHECK(place(left_toe).z() > 0);
}

TEST_CASE("the humanoid: files, mirrors, and who is none") {
  const Skeleton& humanoid = canonical_humanoid();
  const Skeleton again = parse_bvh_header(bvh_header_text(humanoid), "it");
  CHECK(is_humanoid(again));
  const Motion standing{humanoid, 0.1, MatrixD::Zero(1, humanoid.channel_count())};
  REQUIRE(mirrored(standing).has_value());
  CHECK(joint_positions(*mirrored(standing)).isApprox(joint_positions(standing)));
  Skeleton other = humanoid;
  other.joints[3].offset *= 2;
  CHECK(is_humanoid(other));
  other.joints[3].name = "Neck";
  CHECK_FALSE(is_humanoid(other));
  other = humanoid;
  other.joints.pop_back();
  CHECK_FALSE(is_humanoid(other));
}

TEST_CASE("the humanoid: angles turn no faster than twice the joint, through 90 degrees too") {
  const Motion motion = squat(canonical_humanoid());
  for (int j = 0; j < motion.skeleton.joint_count(); ++j) {
    CAPTURE(motion.skeleton.joints[static_cast<std::size_t>(j)].name);
    CHECK(largest_gain(motion, j) < 2);
  }
  // With Z X Y hips and knees bend about the middle axis.
  const Motion former = squat(on_former_orders(motion).skeleton);
  CHECK(largest_difference(former, motion) < 1e-9);
  for (const JointRole role : {JointRole::left_hip, JointRole::right_knee})
    CHECK(largest_gain(former, humanoid_roles().joint(role)) > 4);
}

TEST_CASE(
    "the humanoid: with Z X Y it is the humanoid still, and the same motion with new orders") {
  const Motion motion = moving_humanoid(), former = on_former_orders(motion);
  const int knee = former.skeleton.find("left_knee");
  REQUIRE(former.skeleton.joints[static_cast<std::size_t>(knee)].channels !=
          motion.skeleton.joints[static_cast<std::size_t>(knee)].channels);
  CHECK(is_humanoid(former.skeleton));
  const Motion now = with_humanoid_orders(former);
  for (std::size_t j = 0; j < now.skeleton.joints.size(); ++j)
    CHECK(now.skeleton.joints[j].channels == canonical_humanoid().joints[j].channels);
  CHECK(largest_difference(now, former) < 1e-9);
  CHECK((now.channels.bottomRows(59) - now.channels.topRows(59)).cwiseAbs().maxCoeff() < 30);
  CHECK(with_humanoid_orders(motion).channels == motion.channels);
  Motion other = former;
  std::ranges::reverse(other.skeleton.joints[static_cast<std::size_t>(knee)].channels);
  CHECK_FALSE(is_humanoid(other.skeleton));
  CHECK(with_humanoid_orders(other).channels == former.channels);
}

}  // namespace humanoid_test
