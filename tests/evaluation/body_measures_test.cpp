#include <doctest/doctest.h>

#include <cmath>
#include <tuple>

#include "base/capture_bound.hpp"
#include "evaluation/bone_length.hpp"
#include "evaluation/foot_slide.hpp"
#include "evaluation/orientation_error.hpp"
#include "evaluation/sample_spread.hpp"
#include "mcdbn/base/errors.hpp"
#include "motion/foot_joints.hpp"

namespace mcdbn {
namespace {

Skeleton chain(const std::vector<std::string>& names) {
  Skeleton skeleton;
  for (std::size_t i = 0; i < names.size(); ++i) {
    Joint joint;
    joint.name = names[i];
    joint.parent = static_cast<int>(i) - 1;
    skeleton.joints.push_back(joint);
  }
  return skeleton;
}

}  // namespace

TEST_CASE("foot_joints: by name, in any case") {
  CHECK(foot_joints(chain({"Hips", "LeftFoot", "RightToeBase", "lAnkle", "TOES_R", "Hand"})) ==
        std::vector<int>{1, 2, 3, 4});
  CHECK(foot_joints(chain({"Hips", "Head"})).empty());
}

TEST_CASE("foot_slide: by hand") {
  // 10 frames a second. The foot (joint 1) stands still for frames 0 to 3, then swings up and away.
  MatrixD truth = MatrixD::Zero(7, 6);
  truth.col(4) << 50, 52, 50, 51, 120, 200, 60;
  truth.col(3) << 0, 1, 1, 1, 200, 400, 600;
  MatrixD regenerated = truth;
  regenerated.col(3) << 0, 3, 9, 18, 500, 900, 1000;
  regenerated.col(5) << 0, 4, 12, 24, 0, 0, 0;
  const FootSlide slide = foot_slide(truth, regenerated, {1}, 10);
  CHECK(slide.planted == 3);
  CHECK(slide.truth_mm_s == doctest::Approx(10.0 / 3));
  CHECK(slide.regenerated_mm_s == doctest::Approx((50 + 100 + 150) / 3.0));
  CHECK(std::isnan(foot_slide(truth, regenerated, {}, 10).truth_mm_s));
  CHECK(foot_slide(truth, truth, {1}, 10).regenerated_mm_s == doctest::Approx(slide.truth_mm_s));
}

TEST_CASE("foot_slide: a low foot that is fast is not planted, nor a slow one up in the air") {
  MatrixD truth = MatrixD::Zero(5, 3);
  truth.col(0) << 0, 50, 100, 100, 100;  // 500 mm/s at 10 Hz, then at rest
  truth.col(1) << 0, 0, 0, 60, 60;
  CHECK(foot_slide(truth, truth, {0}, 10).planted == 0);
  truth.col(1).setZero();
  CHECK(foot_slide(truth, truth, {0}, 10).planted == 2);
  // Up to 40 mm and 400 mm/s.
  for (const auto& [height, step, planted] :
       {std::tuple(40.0, 40.0, 4), std::tuple(41.0, 40.0, 2), std::tuple(40.0, 41.0, 3)}) {
    MatrixD edge = MatrixD::Zero(5, 3);
    edge.col(0) << 0, step, step, step, step;
    edge.col(1) << 0, 0, 0, height, height;
    CAPTURE_BOUND(height);
    CAPTURE_BOUND(step);
    CHECK(foot_slide(edge, edge, {0}, 10).planted == planted);
  }
  // Each foot has its own ground: an ankle is never as low as a toe.
  MatrixD two(5, 6);
  two << truth, truth;
  two.col(4).array() += 90;
  CHECK(foot_slide(two, two, {0, 1}, 10).planted == 4);
  CHECK_THROWS_AS(foot_slide(two, truth, {0}, 10), ShapeError);
  CHECK_THROWS_AS(foot_slide(two, two, {2}, 10), ShapeError);
}

TEST_CASE("bone_length_spread_mm: zero for a rigid body, by hand for a stretching one") {
  const Skeleton skeleton = chain({"Hips", "Knee", "Foot"});
  MatrixD positions(2, 9);
  positions << 0, 0, 0, 300, 400, 0, 300, 400, 100,  //
      1, 2, 3, 1, 2, 503, 1, 102, 503;               // turned and moved
  CHECK(bone_length_spread_mm(positions, skeleton, 0) < 1e-9);
  positions(1, 7) = 142;  // the second bone is 100 mm, then 140 mm
  CHECK(bone_length_spread_mm(positions, skeleton, 0) == doctest::Approx(20.0 / 2));
  CHECK(bone_length_spread_mm(positions.leftCols(3), chain({"Hips"}), 0) == 0);
  CHECK_THROWS_AS(bone_length_spread_mm(positions.leftCols(6), skeleton, 0), ShapeError);
}

TEST_CASE("bone_length_spread_mm: the way to the root is no bone") {
  const Skeleton skeleton = chain({"scene", "reference", "Hips", "Knee", "Foot"});
  MatrixD positions(2, 15);
  positions << 0, 0, 0, 50, 0, 0, 0, 0, 0, 300, 400, 0, 300, 400, 100,  //
      0, 0, 0, 80, 9, 0, 1, 2, 3, 1, 2, 503, 1, 142, 503;
  // The shank is 100 mm, then 140 mm; the reference and the hips travel.
  CHECK(bone_length_spread_mm(positions, skeleton, 2) == doctest::Approx(20.0 / 2));
  CHECK(bone_length_spread_mm(positions.leftCols(9), chain({"scene", "reference", "Hips"}), 2) ==
        0);
}

TEST_CASE("diversity_mm: mean over pairs of samples") {
  MatrixD a = MatrixD::Zero(2, 6), b = a, c = a;
  b(0, 3) = 10;            // 5 mm from a on average
  c(0, 3) = c(1, 4) = 20;  // 20 mm from a, 15 mm from b
  b.row(1).array() += 7;   // travel of the whole body is no diversity of its motion
  CHECK(diversity_mm({a, b, c}) == doctest::Approx((5.0 + 20 + 15) / 3));
  CHECK(diversity_mm({a, a}) == 0);
  CHECK(std::isnan(diversity_mm({a})));
}

TEST_CASE("mpjae_deg: by hand; of turns that move no joint, too") {
  Skeleton skeleton = chain({"Hips", "Knee", "Ankle", "Toe"});
  for (std::size_t j = 0; j < 3; ++j)  // the toe never turns
    skeleton.joints[j].channels = {Channel::y_rotation, Channel::x_rotation};
  for (std::size_t j = 1; j < 4; ++j) skeleton.joints[j].offset = {0, -10, 0};
  Motion truth{skeleton, 0.1, MatrixD::Zero(2, 6)};
  Motion twisted = truth;
  twisted.channels(0, 2) = 90;  // the shank about its own length, and back at the ankle
  twisted.channels(0, 4) = -90;
  CHECK(joint_positions(twisted).isApprox(joint_positions(truth)));
  CHECK(mpjae_deg(truth, twisted) == doctest::Approx(90.0 / 6));
  twisted.channels(1, 0) = -170;  // all joints of the other frame
  CHECK(mpjae_deg(truth, twisted) == doctest::Approx((90.0 + 3 * 170) / 6));
  CHECK(mpjae_deg(truth, truth) == doctest::Approx(0));
  // By name, in any order.
  Motion other = twisted;
  std::swap(other.skeleton.joints[1].name, other.skeleton.joints[2].name);
  CHECK(mpjae_deg(truth, other) == doctest::Approx((90.0 + 3 * 170) / 6));
  other.channels(0, 4) = 0;
  CHECK(mpjae_deg(truth, other) == doctest::Approx((2 * 90.0 + 3 * 170) / 6));

  // Without a joint that the other lacks.
  other.skeleton.joints[1].name = "Shin";
  CHECK(mpjae_deg(truth, other) == doctest::Approx((90.0 + 2 * 170) / 4));
  for (Joint& joint : other.skeleton.joints) joint.name += " of another";
  CHECK(std::isnan(mpjae_deg(truth, other)));
  CHECK_THROWS_AS(mpjae_deg(truth, {skeleton, 0.1, MatrixD::Zero(3, 6)}), ShapeError);
  for (Joint& joint : skeleton.joints) joint.channels.clear();
  const Motion still{skeleton, 0.1, MatrixD::Zero(2, 0)};
  CHECK(std::isnan(mpjae_deg(still, still)));
}

}  // namespace mcdbn
