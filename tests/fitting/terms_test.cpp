// Every cost against finite differences, and its residuals against their formulas. CHECK is glog's
// here, which comes with Ceres and ends the program where it fails: so DOCTEST_CHECK.

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>

#include "fitting/rotation.hpp"
#include "fitting/terms/camera_lean.hpp"
#include "fitting/terms/ground_contact.hpp"
#include "fitting/terms/linear_term.hpp"
#include "fitting/terms/reprojection.hpp"
#include "fitting/terms/standing_foot.hpp"

using namespace mcdbn;

namespace {

/// Unknowns of a cost, block by block.
struct Unknowns {
  std::vector<std::vector<double>> blocks;

  Unknowns(const ceres::CostFunction& cost, unsigned seed, double size) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, size);
    for (const int count : cost.parameter_block_sizes()) {
      blocks.emplace_back();
      for (int i = 0; i < count; ++i) blocks.back().push_back(normal(random));
    }
  }
  std::vector<double const*> pointers() const {
    std::vector<double const*> result;
    for (const auto& block : blocks) result.push_back(block.data());
    return result;
  }
};

Eigen::VectorXd residuals(const ceres::CostFunction& cost, const Unknowns& at) {
  Eigen::VectorXd result(cost.num_residuals());
  REQUIRE(cost.Evaluate(at.pointers().data(), result.data(), nullptr));
  return result;
}

/// Analytic Jacobians, of all blocks at once and of each alone, against central differences.
void check_jacobians(const ceres::CostFunction& cost, Unknowns at) {
  const int rows = cost.num_residuals();
  std::vector<std::vector<double>> values;
  std::vector<double*> all;
  for (const auto& block : at.blocks)
    values.emplace_back(static_cast<std::size_t>(rows) * block.size(), 777.0);
  for (auto& value : values) all.push_back(value.data());
  Eigen::VectorXd got(rows);
  REQUIRE(cost.Evaluate(at.pointers().data(), got.data(), all.data()));
  DOCTEST_CHECK((got - residuals(cost, at)).norm() < 1e-12);
  for (std::size_t b = 0; b < at.blocks.size(); ++b) {
    CAPTURE(b);
    std::vector<double> alone(values[b].size(), 777.0);
    std::vector<double*> one(at.blocks.size(), nullptr);
    one[b] = alone.data();
    REQUIRE(cost.Evaluate(at.pointers().data(), got.data(), one.data()));
    DOCTEST_CHECK(alone == values[b]);
    for (std::size_t i = 0; i < at.blocks[b].size(); ++i) {
      constexpr double kStep = 1e-6;
      const double here = at.blocks[b][i];
      at.blocks[b][i] = here + kStep;
      const Eigen::VectorXd after = residuals(cost, at);
      at.blocks[b][i] = here - kStep;
      const Eigen::VectorXd slope = (after - residuals(cost, at)) / (2 * kStep);
      at.blocks[b][i] = here;
      for (int row = 0; row < rows; ++row)
        DOCTEST_CHECK(values[b][static_cast<std::size_t>(row) * at.blocks[b].size() + i] ==
                      doctest::Approx(slope[row]).epsilon(1e-5).scale(1 + std::abs(slope[row])));
    }
  }
}

const std::vector<Lever> kArm{{0, {0.1, -0.5, 0.05}}, {2, {-0.2, 0.1, 0.15}}, {3, {0, 0.25, -0.1}}};
const Eigen::Vector3d kRoot{0.3, -0.2, 4};

}  // namespace

TEST_CASE("terms: a joint is where its root, its turns and its lengths put it") {
  const JointPlace place(kArm, kRoot, true);
  const double turns[3][3] = {{0.3, -0.1, 0.2}, {0, 0, 0}, {-0.4, 0.5, 1}};
  const double shift[3] = {0.01, 0.02, -0.3}, lengths[3] = {0.1, -0.05, 0};
  double const* const unknowns[] = {turns[0],    turns[1],    turns[2],   shift,
                                    &lengths[0], &lengths[1], &lengths[2]};
  Eigen::Vector3d wanted = kRoot + Eigen::Vector3d(0.01, 0.02, -0.3);
  for (std::size_t i = 0; i < 3; ++i)
    wanted += std::exp(lengths[i]) *
              (rotation_of(Eigen::Map<const Eigen::Vector3d>(turns[i])) * kArm[i].bone);
  DOCTEST_CHECK((place.at(unknowns) - wanted).norm() < 1e-12);
}

TEST_CASE("terms: reprojection") {
  for (const bool body_unknown : {false, true}) {
    CAPTURE(body_unknown);
    const Reprojection cost({kArm, kRoot, body_unknown}, 0.4, {0.1, -0.05}, 0.003);
    for (unsigned seed = 1; seed <= 3; ++seed) check_jacobians(cost, {cost, seed, 0.3});
    const Eigen::VectorXd still = residuals(cost, {cost, 1, 0.0});
    const Eigen::Vector3d x = kRoot + kArm[0].bone + kArm[1].bone + kArm[2].bone;
    DOCTEST_CHECK(still[0] == doctest::Approx((x.x() / x.z() - 0.1) / 0.003));
    DOCTEST_CHECK(still[1] == doctest::Approx((x.y() / x.z() + 0.05) / 0.003));
  }
}

TEST_CASE("terms: reprojection near the camera and behind it: the further, the further off") {
  const Eigen::Vector3d x = kArm[0].bone + kArm[1].bone + kArm[2].bone;
  const Eigen::Vector2d ray(0.1, -0.05);
  const auto shown = [&](double depth) -> Eigen::Vector2d {
    const Reprojection cost({kArm, {0, 0, depth - x.z()}, false}, 0.4, ray, 0.003);
    return residuals(cost, {cost, 1, 0.0}) * 0.003 + ray;
  };
  // As if at 0.4² / (2·0.4 - z), which goes on from z without a bend.
  DOCTEST_CHECK((shown(-0.9) - x.head<2>() * (0.8 + 0.9) / 0.16).norm() < 1e-12);
  DOCTEST_CHECK((shown(0.4) - x.head<2>() / 0.4).norm() < 1e-12);
  constexpr double kStep = 1e-5;
  const Eigen::Vector2d before = (shown(0.4) - shown(0.4 - kStep)) / kStep,
                        after = (shown(0.4 + kStep) - shown(0.4)) / kStep;
  DOCTEST_CHECK((before - after).norm() < 1e-3 * after.norm());
  for (const double depth : {0.3, 0.1, 0.0, -0.5, -5.0, -50.0}) {
    CAPTURE(depth);
    DOCTEST_CHECK(shown(depth - 0.1).norm() > shown(depth).norm());
    const Reprojection cost({kArm, {0, 0, depth - x.z()}, true}, 0.4, ray, 0.003);
    check_jacobians(cost, {cost, 1, 0.1});
  }
}

TEST_CASE("terms: reprojection through a camera of unknown focal length") {
  for (const bool body_unknown : {false, true}) {
    const Reprojection cost({kArm, kRoot, body_unknown}, 0.4, {0.1, -0.05}, 0.003, true);
    Unknowns at(cost, 1, 0.3);
    for (unsigned seed = 1; seed <= 3; ++seed) check_jacobians(cost, {cost, seed, 0.3});
    // Twice the focal length: everything is seen twice as far from the middle.
    at.blocks.back()[0] = 0;
    const Eigen::Vector2d ray(0.1, -0.05), once = residuals(cost, at) * 0.003 + ray;
    at.blocks.back()[0] = std::log(2);
    DOCTEST_CHECK((residuals(cost, at) * 0.003 + ray - 2 * once).norm() < 1e-12);
  }
  // Behind the camera, too: 1.7 m and 0.4² as in the case before.
  const Reprojection behind({kArm, {0, 0, -1}, false}, 0.4, {0.1, -0.05}, 0.003, true);
  Unknowns at(behind, 1, 0.0);
  at.blocks.back()[0] = std::log(2);
  const Eigen::Vector3d x = kArm[0].bone + kArm[1].bone + kArm[2].bone;
  const Eigen::Vector2d wanted =
      (2 * x.head<2>() * 1.7 / 0.16 - Eigen::Vector2d(0.1, -0.05)) / 0.003;
  DOCTEST_CHECK((residuals(behind, at) - wanted).norm() < 1e-9);
  check_jacobians(behind, {behind, 1, 0.1});
}

TEST_CASE("terms: a foot on the ground") {
  const Eigen::Vector3d up = Eigen::Vector3d(0.1, -0.9, -0.3).normalized();
  for (const bool body_unknown : {false, true})
    for (const bool camera_unknown : {false, true}) {
      CAPTURE(body_unknown);
      CAPTURE(camera_unknown);
      const GroundContact cost({kArm, kRoot, body_unknown}, up, 0.05, camera_unknown);
      for (unsigned seed = 1; seed <= 3; ++seed) check_jacobians(cost, {cost, seed, 0.3});
      Unknowns at(cost, 1, 0);
      at.blocks[static_cast<std::size_t>(body_unknown ? 7 : 4)] = {-1.1};
      const Eigen::Vector3d x = kRoot + kArm[0].bone + kArm[1].bone + kArm[2].bone;
      DOCTEST_CHECK(residuals(cost, at)[0] == doctest::Approx((up.dot(x) + 1.1) / 0.05));
      if (!camera_unknown) continue;
      // The ground leans as the camera does.
      at.blocks.back() = {0.2, 0, -0.1};
      const Eigen::Vector3d leaning = rotation_of({0.2, 0, -0.1}) * up;
      DOCTEST_CHECK(residuals(cost, at)[0] == doctest::Approx((leaning.dot(x) + 1.1) / 0.05));
    }
}

TEST_CASE("terms: how a camera leans") {
  for (const double roll : {0.0, 0.7, -2.5}) {
    CAPTURE(roll);
    const Eigen::Vector3d right(std::cos(roll), -std::sin(roll), 0);
    const CameraLean cost({0.1, -0.2, 0.05, 0.02}, right);
    const Unknowns at(cost, 3, 0.3);
    check_jacobians(cost, at);
    const double about_right = at.blocks[0][0] * right.x() + at.blocks[0][1] * right.y();
    DOCTEST_CHECK(residuals(cost, at)[0] == doctest::Approx((about_right - 0.1) / 0.05));
    DOCTEST_CHECK(residuals(cost, at)[1] == doctest::Approx((-at.blocks[0][2] + 0.2) / 0.02));
  }
}

TEST_CASE("terms: a standing foot") {
  std::vector<Lever> later = kArm;
  later[1].bone << 0.05, 0.2, 0.1;
  for (const bool body_unknown : {false, true}) {
    CAPTURE(body_unknown);
    const Eigen::Vector3d further = kRoot + Eigen::Vector3d(0.1, 0, 0.2);
    const StandingFoot cost({kArm, kRoot, body_unknown}, {later, further, body_unknown}, 0.02);
    for (unsigned seed = 1; seed <= 3; ++seed) check_jacobians(cost, {cost, seed, 0.3});
    const Eigen::Vector3d moved = further - kRoot + later[1].bone - kArm[1].bone;
    DOCTEST_CHECK((residuals(cost, {cost, 1, 0.0}) - moved / 0.02).norm() < 1e-9);
  }
}

TEST_CASE("terms: a weighted sum of unknowns") {
  const LinearTerm cost({1, -2, 0.5}, Eigen::Vector3d(0.1, 0.2, -0.3), 0.04);
  const Unknowns at(cost, 5, 1);
  check_jacobians(cost, at);
  for (int i = 0; i < 3; ++i)
    DOCTEST_CHECK(residuals(cost, at)[i] ==
                  doctest::Approx((at.blocks[0][i] - 2 * at.blocks[1][i] + 0.5 * at.blocks[2][i] -
                                   Eigen::Vector3d(0.1, 0.2, -0.3)[i]) /
                                  0.04));
}

TEST_CASE("terms: the left Jacobian is how a rotation follows its vector") {
  for (const Eigen::Vector3d& turn :
       {Eigen::Vector3d(0.4, -1, 0.3), Eigen::Vector3d(1e-5, 0, 2e-5)}) {
    for (int axis = 0; axis < 3; ++axis) {
      constexpr double kStep = 1e-6;
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
      const Eigen::Matrix3d change =
          (rotation_of(turn + step) - rotation_of(turn - step)) / (2 * kStep);
      const Eigen::Matrix3d wanted =
          cross_matrix(left_jacobian(turn).col(axis)) * rotation_of(turn);
      DOCTEST_CHECK((change - wanted).norm() < 1e-8);
    }
  }
}
