#include "motion/other_body.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <vector>

#include "base/capture_bound.hpp"
#include "base/near.hpp"
#include "motion/body_size.hpp"
#include "motion/synthetic_motion.hpp"

namespace other_body_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// A body with two sides. @param placed position channels on every joint, below a joint that stands
/// still, as in the Bandai files
Skeleton two_sided(bool placed) {
  const std::vector<Channel> turns{z_rotation, x_rotation, y_rotation};
  const std::vector<Channel> all{x_position, y_position, z_position,
                                 z_rotation, x_rotation, y_rotation};
  const auto& channels = placed ? all : turns;
  Skeleton body;
  if (placed) body.joints.push_back(make_joint("World", -1, {0, 0, 0}, all));
  const int hips = placed ? 1 : 0;
  body.joints.push_back(make_joint("Hips", hips - 1, {0, 0, 0}, all));
  for (const auto& [side, sign] : {std::pair{"Left", 1.0}, std::pair{"Right", -1.0}}) {
    const int first = body.joint_count();
    const std::string name = side;
    body.joints.push_back(make_joint(name + "UpLeg", hips, {sign * 9, -5, 0}, channels));
    body.joints.push_back(make_joint(name + "Leg", first, {0, -41.7, 0}, channels));
    body.joints.push_back(make_joint(name + "Foot", first + 1, {0, -41.8, 0}, channels));
  }
  body.joints.push_back(make_joint("Spine", hips, {0, 50, 0}, channels));
  return body;
}

/// The length of the bone that ends at a joint, in a frame.
double bone(const MatrixD& positions, const Skeleton& skeleton, int joint, int frame) {
  const int parent = skeleton.joints[static_cast<std::size_t>(joint)].parent;
  return (positions.row(frame).segment<3>(3 * joint) - positions.row(frame).segment<3>(3 * parent))
      .norm();
}

/// By how much each bone of an other body is longer, 0 for the root and bones without length.
std::vector<double> factors(const Motion& motion, const OtherBody& deviations, std::uint64_t seed) {
  const Motion other = with_other_body(motion, deviations, seed);
  std::vector<double> list;
  for (int j = 0; j < motion.skeleton.joint_count(); ++j) {
    const double own = motion.skeleton.joints[static_cast<std::size_t>(j)].offset.norm();
    list.push_back(own > 0 ? other.skeleton.joints[static_cast<std::size_t>(j)].offset.norm() / own
                           : 0);
  }
  return list;
}

double deviation(const std::vector<double>& values) {
  double sum = 0, squares = 0;
  for (const double value : values) {
    sum += value;
    squares += value * value;
  }
  const auto count = static_cast<double>(values.size());
  return std::sqrt(squares / count - sum * sum / (count * count));
}

}  // namespace

TEST_CASE("other body: bones grow as asked, both sides alike, and turn as before") {
  for (const Skeleton& skeleton : {two_sided(false), two_sided(true)}) {
    const Motion before = swinging(skeleton, 20);
    Motion after = before;
    // Of a pair the first is asked: the left leg.
    scale_bones(after, [](int joint) { return 1 + 0.1 * joint; });
    const MatrixD places = joint_positions(before), others = joint_positions(after);
    const int root = skeleton.find("Hips");
    for (const auto& [name, asked] : {std::pair<std::string, std::string>{"LeftLeg", "LeftLeg"},
                                      {"RightLeg", "LeftLeg"},
                                      {"LeftFoot", "LeftFoot"},
                                      {"RightFoot", "LeftFoot"},
                                      {"Spine", "Spine"}}) {
      CAPTURE_BOUND(name);
      const int joint = skeleton.find(name);
      for (const int frame : {0, 19})
        CHECK(bone(others, skeleton, joint, frame) ==
              doctest::Approx((1 + 0.1 * skeleton.find(asked)) *
                              bone(places, skeleton, joint, frame)));
    }
    // Who has longer legs stands higher and walks further.
    const double taller = body_height(after.skeleton) / body_height(skeleton);
    CHECK(taller > 1.1);
    CHECK((others.middleCols(3 * root, 3) - taller * places.middleCols(3 * root, 3))
              .cwiseAbs()
              .maxCoeff() < 1e-9);
    for (int j = 0; j < skeleton.joint_count(); ++j)
      for (std::size_t k = 0; k < skeleton.joints[static_cast<std::size_t>(j)].channels.size(); ++k)
        if (is_rotation(skeleton.joints[static_cast<std::size_t>(j)].channels[k])) {
          const Eigen::Index column = skeleton.first_channel(j) + static_cast<Eigen::Index>(k);
          CHECK(after.channels.col(column) == before.channels.col(column));
        }
  }
}

TEST_CASE("other body: the whole path grows, also what a joint above the hips travels") {
  Motion before = swinging(two_sided(true), 20);
  for (int t = 0; t < 20; ++t) before.channels(t, 2) = 12.0 * t;  // World's z
  const int root = before.skeleton.find("Hips");
  REQUIRE(moving_root({&before}) == root);
  Motion after = before;
  scale_bones(after, [](int joint) { return 1 + 0.1 * joint; });
  const double taller = body_height(after.skeleton) / body_height(before.skeleton);
  CHECK(taller > 1.1);
  const MatrixD places = joint_positions(before).middleCols(3 * root, 3),
                others = joint_positions(after).middleCols(3 * root, 3);
  CHECK((others - taller * places).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE("other body: height makes all bones longer, proportions each by itself") {
  const Motion motion = swinging(two_sided(false), 2);
  const int shin = motion.skeleton.find("LeftLeg"), foot = motion.skeleton.find("LeftFoot");
  std::vector<double> heights, shins, ratios;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const auto tall = factors(motion, {0.1, 0}, seed);
    CHECK(tall[foot] == doctest::Approx(tall[shin]));
    heights.push_back(std::log(tall[shin]));
    const auto own = factors(motion, {0, 0.2}, seed);
    CHECK(own[motion.skeleton.find("RightFoot")] == doctest::Approx(own[foot]));
    shins.push_back(std::log(own[shin]));
    ratios.push_back(std::log(own[foot] / own[shin]));
  }
  CHECK(deviation(heights) == near(0.1, 0.15));
  CHECK(deviation(shins) == near(0.2, 0.15));
  CHECK(deviation(ratios) == near(0.2 * std::sqrt(2.0), 0.15));
}

TEST_CASE("other body: both sides are alike where single letters mark them, as in ASF") {
  Motion motion = swinging(two_sided(false), 2);
  for (Joint& joint : motion.skeleton.joints) {
    if (joint.name.starts_with("Left")) joint.name.erase(1, 3);
    if (joint.name.starts_with("Right")) joint.name.erase(1, 4);
    std::ranges::transform(joint.name, joint.name.begin(),
                           [](unsigned char letter) { return std::tolower(letter); });
  }
  const auto own = factors(motion, {0, 0.2}, 3);
  for (const char* bone : {"leg", "foot"}) {
    const auto left = static_cast<std::size_t>(motion.skeleton.find(std::string("l") + bone)),
               right = static_cast<std::size_t>(motion.skeleton.find(std::string("r") + bone));
    CHECK(own[left] == doctest::Approx(own[right]));
    CHECK(own[left] != doctest::Approx(1));
  }
}

TEST_CASE("other body: the same seed makes the same person, no deviation the own one") {
  const Motion motion = swinging(two_sided(false), 2);
  CHECK(factors(motion, {}, 7) == factors(motion, {}, 7));
  CHECK(factors(motion, {}, 7) != factors(motion, {}, 8));
  const Motion same = with_other_body(motion, {0, 0}, 7);
  CHECK(same.channels.isApprox(motion.channels, 1e-12));
  CHECK(same.skeleton.joints[3].offset.isApprox(motion.skeleton.joints[3].offset, 1e-12));
}

}  // namespace other_body_test
