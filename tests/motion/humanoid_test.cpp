#include "mcdbn/motion/humanoid.hpp"

#include <doctest/doctest.h>

#include "mcdbn/formats/bvh.hpp"
#include "motion/body_size.hpp"
#include "motion/mirror.hpp"
#include "motion/rest_pose.hpp"

using namespace mcdbn;

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
