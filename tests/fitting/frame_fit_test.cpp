#include "fitting/frame_fit.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace mcdbn;

TEST_CASE("frame fit: the Jacobian is that of finite differences") {
  Observation observation{{{0, {10, -20, 3}}, {1, {-5, 30, 8}}, {2, {12, 2, -9}}}, {0, 0}, 1};
  const Eigen::Vector3d root(20, -10, 300);
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (const double size : {0.0, 1e-5, 0.3, 1.5}) {
    CAPTURE(size);
    Eigen::VectorXd correction(12);
    for (double& value : correction) value = size * normal(random);
    const auto jacobian = ray_jacobian(observation, root, correction);
    constexpr double kStep = 1e-5;
    for (Eigen::Index k = 0; k < correction.size(); ++k) {
      const auto ray = [&](double step) -> Eigen::Vector2d {
        Eigen::VectorXd moved = correction;
        moved[k] += step;
        const Eigen::Vector3d position = corrected_position(observation.levers, root, moved);
        return position.head<2>() / position.z();
      };
      // Rays are near 1: their rounding over the step, and the step's square.
      CHECK((jacobian.col(k) - (ray(kStep) - ray(-kStep)) / (2 * kStep)).norm() < 1e-9);
    }
  }
}

TEST_CASE("frame fit: a held depth and the prior share as their variances say") {
  constexpr double kBone = 20, kDeviation = 0.2, kNearer = 0.01;
  // Across the image: a turn moves its end in depth by its length, to first order.
  const std::vector<Lever> levers{{0, {kBone, 0, 0}}};
  const Eigen::Vector3d root(0, 0, 300);
  FramePrior prior;
  prior.root = root;
  prior.parents = {-1};
  prior.turn_deviation_rad = {kDeviation};
  prior.root_deviation = 1e-6;
  const Observation blind{levers, {kBone / 300, 0}, 1e12};
  for (const double variance : {1e-6, 4.0, 1e6}) {
    CAPTURE(variance);
    prior.held = {{levers, 300 - kNearer, variance}};
    const FrameFit fit = fit_frame({blind}, prior);
    const double of_turn = kDeviation * kDeviation * kBone * kBone;
    const double depth = corrected_position(levers, root, fit.correction).z();
    // The next order is the turn's cube.
    CHECK(std::abs(300 - depth - kNearer * of_turn / (of_turn + variance)) < 1e-9);
  }
}

TEST_CASE(
    "frame fit: a ray and the prior share as their variances say, and a child's turn as well") {
  constexpr double kBone = 20, kDepth = 300, kSeen = 1e-5, kLikeness = 0.6;
  const Eigen::Vector3d root(0, 0, kDepth);
  FramePrior prior;
  prior.root = root;
  prior.parents = {-1, 0};
  prior.likeness = kLikeness;
  prior.root_deviation = 1e-9;
  // Two bones along x: a turn about z moves its end along y by its length, to first order.
  const std::vector<Lever> levers{{0, {kBone, 0, 0}}, {1, {kBone, 0, 0}}};
  for (const double deviation : {0.02, 0.2}) {
    for (const double variance : {1e-10, 1e-4, 1e-2}) {
      CAPTURE(deviation);
      CAPTURE(variance);
      prior.turn_deviation_rad = {deviation, deviation};
      const FrameFit fit = fit_frame({{levers, {2 * kBone / kDepth, kSeen}, variance}}, prior);
      const double slope = kBone / kDepth, turns = deviation * deviation;
      // The variance of both turns' sum, and each turn's covariance with it.
      const double of_sum = 2 * (1 + kLikeness) * turns, with_sum = (1 + kLikeness) * turns;
      const double gain = slope * with_sum / (slope * slope * of_sum + variance);
      for (const Eigen::Index turn : {2, 5})
        CHECK(std::abs(fit.correction[turn] - gain * kSeen) < 1e-6 * gain * kSeen + 1e-12);
    }
  }
}

TEST_CASE("frame fit: of two turns the one that is less sure turns more, its child by its share") {
  constexpr double kBone = 20, kDepth = 300, kSeen = 1e-5, kLikeness = 0.6, kSure = 0.02,
                   kUnsure = 0.06;
  FramePrior prior;
  prior.root = {0, 0, kDepth};
  prior.parents = {-1, 0};
  prior.likeness = kLikeness;
  prior.root_deviation = 1e-9;
  prior.turn_deviation_rad = {kSure, kUnsure};
  const std::vector<Lever> levers{{0, {kBone, 0, 0}}, {1, {kBone, 0, 0}}};
  const double variance = 1e-6, slope = kBone / kDepth;
  const FrameFit fit = fit_frame({{levers, {2 * slope, kSeen}, variance}}, prior);
  // Covariance of the two turns: their variances, and likeness times both deviations.
  const double between = kLikeness * kSure * kUnsure;
  const double of_sum = kSure * kSure + kUnsure * kUnsure + 2 * between;
  const double gain = slope / (slope * slope * of_sum + variance);
  const double sure = gain * (kSure * kSure + between) * kSeen,
               unsure = gain * (kUnsure * kUnsure + between) * kSeen;
  CHECK(std::abs(fit.correction[2] - sure) < 1e-6 * sure);
  CHECK(std::abs(fit.correction[5] - unsure) < 1e-6 * unsure);
}
