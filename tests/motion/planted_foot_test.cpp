#include "mcdbn/motion/planted_foot.hpp"

#include <doctest/doctest.h>

using namespace mcdbn;

TEST_CASE("planted foot: low and slow, up to both limits") {
  const PlantedFoot foot{.within_m = 0.04, .below_m_s = 0.4};
  CHECK(foot.holds(0.04, 0.4));
  CHECK(foot.holds(-0.01, 0));
  CHECK_FALSE(foot.holds(0.0401, 0));
  CHECK_FALSE(foot.holds(0, 0.401));
  CHECK(foot.confidence(0, 0) == 1);
  CHECK(foot.confidence(0.04, 0) == doctest::Approx(std::exp(-0.5)));
  CHECK(foot.confidence(0.08, 0.4) == doctest::Approx(std::exp(-2.5)));
}

TEST_CASE("planted foot: what training, the fit and evaluation take for one") {
  CHECK(kPlantedInCapture.within_m == 0.04);
  CHECK(kPlantedInCapture.below_m_s == 0.4);
  CHECK(kPlantedInAnswer.within_m == 0.05);
  CHECK(kPlantedInAnswer.below_m_s == 0.4);
}

TEST_CASE("planted foot: a step is as high as the higher of its frames") {
  MatrixD positions(3, 6);
  positions << 0, 0, 0, 1, 2, 3,  //
      0, 0, 0, 1.5, 5, 2,         //
      0, 9, 0, 2, 4, 2;
  const JointStep up = step_to(positions, 1, 1), down = step_to(positions, 1, 2);
  CHECK(up.moved == Eigen::RowVector3d(0.5, 3, -1));
  CHECK(up.height == 5);
  CHECK(down.moved == Eigen::RowVector3d(0.5, -1, 0));
  CHECK(down.height == 5);
  CHECK(step_to(positions, 0, 2).height == 9);
}
