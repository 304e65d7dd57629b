#include "motion/mean_body.hpp"

#include <doctest/doctest.h>

#include "mcdbn/base/errors.hpp"
#include "motion/body_size.hpp"
#include "motion/synthetic_motion.hpp"

namespace mean_body_test {

using namespace mcdbn;

namespace {

Skeleton scaled(Skeleton skeleton, double factor) {
  for (Joint& joint : skeleton.joints) joint.offset *= factor;
  return skeleton;
}

}  // namespace

TEST_CASE("mean body: of one person it is that person's, to the bit") {
  const Skeleton one = test::small_body();
  const Skeleton mean = mean_body({one, one, one});
  for (std::size_t j = 0; j < one.joints.size(); ++j)
    CHECK(mean.joints[j].offset == one.joints[j].offset);
}

TEST_CASE("mean body: bones are the mean of people's of the first one's size") {
  const Skeleton first = test::small_body();
  Skeleton second = first;
  const auto at = static_cast<std::size_t>(first.find("Neck"));  // no part of the body's size
  second.joints[at].offset *= 1.5;
  REQUIRE(body_height(second) == doctest::Approx(body_height(first)));
  const Skeleton mean = mean_body({first, scaled(second, 40)});
  CHECK((mean.joints[at].offset - 1.25 * first.joints[at].offset).norm() < 1e-9);
  for (std::size_t j = 0; j < first.joints.size(); ++j) {
    CAPTURE(first.joints[j].name);
    if (j != at) CHECK((mean.joints[j].offset - first.joints[j].offset).norm() < 1e-9);
    CHECK(mean.joints[j].name == first.joints[j].name);
    CHECK(mean.joints[j].channels == first.joints[j].channels);
  }
  // Joints are matched by name, and each has to be there.
  Skeleton other = second;
  other.joints[at].name = "elsewhere";
  CHECK_THROWS_AS(mean_body({first, other}), InputError);
}

TEST_CASE("mean body: what rests in another direction, or moves, stays as the first has it") {
  const Skeleton first = test::small_body();
  Skeleton other = first;
  for (Joint& joint : other.joints) joint.offset = {0, 0, joint.offset.norm()};
  const Skeleton mean = mean_body({first, other});
  for (std::size_t j = 0; j < first.joints.size(); ++j) {
    const Eigen::Vector3d& bone = first.joints[j].offset;
    if (bone.z() < 0.8 * bone.norm() || j == 0) CHECK(mean.joints[j].offset == bone);
  }
  Skeleton moving = first, longer = first;
  for (Skeleton* skeleton : {&moving, &longer})
    skeleton->joints.back().channels.push_back(Channel::x_position);
  longer.joints.back().offset *= 1.1;
  longer.joints.front().offset.x() += 5;
  const Skeleton of_moving = mean_body({moving, longer});
  CHECK(of_moving.joints.back().offset == moving.joints.back().offset);
  CHECK(of_moving.joints.front().offset == moving.joints.front().offset);
}

}  // namespace mean_body_test
