#include "fitting/standing_foot.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace mcdbn;

namespace {

constexpr double kStill = 1e-3, kAround = 2;

/// Seen on one spot all the time, three units away.
std::vector<SeenFoot> standing(std::size_t frames) {
  return std::vector<SeenFoot>(frames, {{0.1, -0.2}, 1, 3});
}

}  // namespace

TEST_CASE("standing foot: one wrong depth is told by the frames around") {
  std::vector<SeenFoot> foot = standing(21);
  foot[10].depth = 9;
  const auto depths = standing_depths(foot, kStill, kAround);
  CHECK(depths[10].depth == doctest::Approx(3).epsilon(1e-12));
  CHECK(depths[10].surely == doctest::Approx(1).epsilon(1e-12));
  // Its neighbours hear it as one among many: its Gaussian's share.
  double all = 0;
  for (int k = 1; k <= 6; ++k) all += 2 * std::exp(-0.125 * k * k);
  CHECK(depths[11].depth == doctest::Approx(3 + 6 * std::exp(-0.125) / all).epsilon(1e-12));
}

TEST_CASE("standing foot: a foot that is elsewhere on the image is not asked") {
  // It steps in frame 10: far on the image, and to another depth.
  std::vector<SeenFoot> foot = standing(21);
  for (std::size_t t = 10; t < foot.size(); ++t) foot[t] = {{0.4, -0.2}, 1, 5};
  const auto depths = standing_depths(foot, kStill, kAround);
  // What comes through is the weights' tail: 1 / (1 + 300²).
  CHECK(std::abs(depths[9].depth - 3) < 1e-4);
  CHECK(std::abs(depths[10].depth - 5) < 1e-4);
  CHECK(depths[9].surely < 0.55);
  CHECK(depths[0].surely == doctest::Approx(1).epsilon(1e-12));
}

TEST_CASE("standing foot: a foot on its way is held nowhere") {
  std::vector<SeenFoot> foot = standing(21);
  for (std::size_t t = 0; t < foot.size(); ++t) {
    foot[t].ray.x() = 10 * kStill * static_cast<double>(t);
  }
  for (const FootDepth& depth : standing_depths(foot, kStill, kAround)) CHECK(depth.surely == 0);
}

TEST_CASE("standing foot: what is not seen neither tells nor is told") {
  std::vector<SeenFoot> foot = standing(21);
  foot[10] = {{0, 0}, 0, 1e6};
  foot[12].surely = 0.5;
  const auto depths = standing_depths(foot, kStill, kAround);
  CHECK(depths[10].surely == 0);
  CHECK(depths[11].depth == doctest::Approx(3).epsilon(1e-12));
  CHECK(depths[11].surely < 1);
  CHECK(depths[12].surely < 0.5);
  CHECK(standing_depths({}, kStill, kAround).empty());
}
